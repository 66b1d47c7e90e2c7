// SPDX-License-Identifier: Apache-2.0
#include "app/recorder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

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

RecordedTime::RecordedTime(Field& field, const SimulationLimits& limits, double start_s)
    : field_(field), limits_(limits), start_s_(start_s) {
    limits_.most_blade_steps = 0;
    limits_.most_wind_steps = 0;
    render::Access::state(field_).light_at_once = true;
}

void RecordedTime::place(const feed::LedFrame& frame) {
    if (!frame.balls.empty())
        field_.set_colliders(frame.balls, frame.time_s);
    std::vector<Body> known; // a follower may show less than its master does
    const std::size_t objects = render::Access::state(field_).objects.count();
    std::ranges::copy_if(frame.bodies, std::back_inserter(known),
                         [&](const Body& body) { return body.object < objects; });
    if (!known.empty())
        field_.set_objects(known, frame.time_s);
    if (frame.blows)
        field_.set_blowers(frame.blowers, frame.time_s);
}

void RecordedTime::perform(const feed::LedFrame& frame) {
    if (frame.idle)
        return;
    place(frame);
    std::size_t change = 0;
    for (std::size_t i = 0; i < frame.eyes.size(); ++i) {
        const std::size_t step = frame.first_step + i;
        for (; change < frame.changes.size() && frame.changes[change].step <= step; ++change)
            apply(frame.changes[change].what);
        field_.simulate(start_s_ + static_cast<double>(step) / kRecordRate, {&frame.eyes[i], 1},
                        limits_);
    }
    for (; change < frame.changes.size(); ++change)
        apply(frame.changes[change].what);
}

std::vector<feed::LedFrame> RecordedTime::take_due(const FlightRecord& record, double time_s) {
    const std::size_t last = record.step_at(time_s);
    feed::LedFrame all;
    all.time_s = time_s;
    all.first_step = static_cast<std::uint32_t>(taken_);
    for (; taken_ <= last; ++taken_) {
        for (; events_taken_ < record.events.size() && record.events[events_taken_].step <= taken_;
             ++events_taken_)
            all.changes.push_back(
                {static_cast<std::uint32_t>(taken_), record.events[events_taken_].change});
        all.eyes.push_back(record.steps[taken_].position);
    }
    return cut_to_size(std::move(all));
}

void RecordedTime::follow(const FlightRecord& record, double time_s) {
    for (const feed::LedFrame& frame : take_due(record, time_s))
        perform(frame);
}

void RecordedTime::apply(const std::variant<Sun, MeanWind>& change) {
    if (const Sun* const sun = std::get_if<Sun>(&change))
        field_.set_sun(*sun);
    else
        field_.set_wind(std::get<MeanWind>(change));
}

std::vector<feed::LedFrame> cut_to_size(feed::LedFrame frame) {
    using feed::kMostLedChanges, feed::kMostLedSteps;
    std::vector<feed::LedFrame> parts;
    while (frame.eyes.size() > kMostLedSteps || frame.changes.size() > kMostLedChanges) {
        feed::LedFrame part = frame;
        // More changes than one holds: the steps before the next one; none where that is due now.
        const std::size_t changes = std::min(frame.changes.size(), kMostLedChanges);
        const std::size_t free = changes < frame.changes.size()
                                     ? frame.changes[changes].step - frame.first_step
                                     : frame.eyes.size();
        const auto steps = std::min({frame.eyes.size(), kMostLedSteps, free});
        const auto end = std::find_if(frame.changes.begin(),
                                      frame.changes.begin() + static_cast<std::ptrdiff_t>(changes),
                                      [&](const feed::LedChange& c) {
                                          return steps > 0 && c.step >= frame.first_step + steps;
                                      });
        part.eyes.resize(steps);
        part.changes.assign(frame.changes.begin(), end);
        frame.eyes.erase(frame.eyes.begin(),
                         frame.eyes.begin() + static_cast<std::ptrdiff_t>(steps));
        frame.changes.erase(frame.changes.begin(), end);
        frame.first_step += static_cast<std::uint32_t>(steps);
        frame.balls.clear();
        frame.bodies.clear();
        frame.blowers.clear();
        frame.blows = false;
        parts.push_back(std::move(part));
    }
    parts.push_back(std::move(frame));
    return parts;
}

} // namespace sward::app
