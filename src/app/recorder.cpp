// SPDX-License-Identifier: Apache-2.0
#include "app/recorder.h"

#include <algorithm>
#include <cmath>

#include "render/access.h"

namespace sward::app {
namespace {

constexpr double kSoon_s =
    1e-9; // a step that is due by so little is due: the times of pictures are sums

RecordStep between(const ViewPose& a, const ViewPose& b, double share, RecordStep step) {
    const auto on = [&](double from, double to) {
        return share >= 1 ? to : from + (to - from) * share;
    }; // the very pose of a picture on a step
    const auto turn = [&](double from, double to) {
        return share >= 1 ? to : from + std::remainder(to - from, 360.0) * share;
    };
    step.position = {on(a.pose.position.x, b.pose.position.x),
                     on(a.pose.position.y, b.pose.position.y),
                     on(a.pose.position.z, b.pose.position.z)};
    step.yaw_deg = turn(a.pose.yaw_deg, b.pose.yaw_deg);
    step.pitch_deg = on(a.pose.pitch_deg, b.pose.pitch_deg);
    step.roll_deg = turn(a.roll_deg, b.roll_deg);
    step.fov_deg = on(a.pose.fov_deg, b.pose.fov_deg);
    return step;
}

} // namespace

std::vector<RecordStep> StepSampler::up_to(double time_s, const ViewPose& pose,
                                           const RecordStep& asked) {
    std::vector<RecordStep> steps;
    RecordStep step = asked;
    while (true) {
        const double due = time_of(next_);
        if (due > time_s + kSoon_s)
            break;
        const bool last = !before_ || due > time_s - kSoon_s || !(time_s > before_s_);
        steps.push_back(between(before_.value_or(pose), pose,
                                last ? 1 : (due - before_s_) / (time_s - before_s_), step));
        step.look_px = {0, 0}; // moved once
        step.wheel = 0;
        ++next_;
    }
    before_ = pose;
    before_s_ = time_s;
    return steps;
}

RecordedTime::RecordedTime(Field& field, const SimulationLimits& limits)
    : field_(field), limits_(limits) {
    limits_.most_blade_steps = 0;
    limits_.most_wind_steps = 0;
    render::Access::state(field_).light_at_once = true;
}

void RecordedTime::step(double time_s, const glm::dvec3& eye) {
    field_.simulate(time_s, {&eye, 1}, limits_);
    ++done_;
}

void RecordedTime::follow(const FlightRecord& record, double time_s) {
    const std::size_t last = record.step_at(time_s);
    while (done_ <= last) {
        for (; events_done_ < record.events.size() && record.events[events_done_].step <= done_;
             ++events_done_)
            apply(record.events[events_done_]);
        step(record.time_of(done_), record.steps[done_].position);
    }
}

void RecordedTime::apply(const RecordEvent& event) {
    if (const Sun* const sun = std::get_if<Sun>(&event.change))
        field_.set_sun(*sun);
    else
        field_.set_wind(std::get<MeanWind>(event.change));
}

} // namespace sward::app
