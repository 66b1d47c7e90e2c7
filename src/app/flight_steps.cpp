// SPDX-License-Identifier: Apache-2.0
// How a flight's field goes on: once a picture as far as the machine can, or by fixed steps, as
// flights do that are kept, shown again, led or followed.
#include <algorithm>
#include <utility>

#include "app/flight.h"
#include "app/lead_links.h"
#include "gl/breath.h"
#include "render/access.h"

namespace sward::app {
namespace {

constexpr double kCatchUp_s = 0.2; // of steps in one go: the window wants to be heard
constexpr double kWait_s = 0.02;   // for the master's next frame
constexpr double kStill_s = 1;     // then the same is drawn again

bool same(const std::vector<Ball>& a, const std::vector<Ball>& b) {
    return std::ranges::equal(a, b, [](const Ball& x, const Ball& y) {
        return x.centre == y.centre && x.radius_m == y.radius_m;
    });
}

bool same(const std::vector<Body>& a, const std::vector<Body>& b) {
    return std::ranges::equal(a, b, [](const Body& x, const Body& y) {
        return x.object == y.object && x.world_from_body == y.world_from_body;
    });
}

} // namespace

bool Flight::by_steps() const {
    return parts_.record != nullptr || parts_.replay != nullptr || parts_.lead != nullptr;
}

RecordedTime& Flight::steps() {
    if (!steps_)
        steps_.emplace(field_, render::limits_of(settings_),
                       parts_.replay != nullptr ? parts_.replay->start_s : sampler_.time_of(0));
    return *steps_;
}

/// A change of the weather: at once, or before the next step.
void Flight::change(const std::variant<Sun, MeanWind>& what) {
    if (!by_steps()) {
        if (const Sun* const sun = std::get_if<Sun>(&what))
            field_.set_sun(*sun);
        else
            field_.set_wind(std::get<MeanWind>(what));
        return;
    }
    changes_.push_back({static_cast<std::uint32_t>(sampler_.count()), what});
    if (parts_.record != nullptr)
        std::visit([this](const auto& one) { parts_.record->add(one); }, what);
}

/// What the source moves, where that is another place or time than the picture's before.
void Flight::place(feed::LedFrame& frame) {
    frame.time_s = clock_.time_s();
    frame.balls = source_.bodies();
    frame.bodies = source_.objects();
    if (!options_.no_wake)
        frame.blowers = source_.blowers();
    const bool blew = blew_;
    blew_ = !frame.blowers.empty();
    frame.blows = blew || blew_;
    const bool any = blew_ || !frame.balls.empty() || !frame.bodies.empty();
    const bool other = blew != blew_ || !same(frame.balls, placed_.balls) ||
                       !same(frame.bodies, placed_.bodies) ||
                       (any && frame.time_s != placed_.time_s);
    if (other) {
        placed_.balls = frame.balls;
        placed_.bodies = frame.bodies;
        placed_.time_s = frame.time_s;
    } else {
        frame.balls.clear();
        frame.bodies.clear();
        frame.blowers.clear();
        frame.blows = false;
    }
}

/// What a picture does to the field. What was asked for is kept with the steps that fall into it.
std::vector<feed::LedFrame> Flight::plan(const Input& input) {
    std::vector<feed::LedFrame> frames;
    if (parts_.replay != nullptr) {
        frames = steps().take_due(*parts_.replay, clock_.time_s());
    } else {
        feed::LedFrame frame;
        frame.first_step = static_cast<std::uint32_t>(sampler_.count());
        RecordStep asked;
        asked.move = input.move;
        asked.look_px = input.look_px;
        asked.wheel = input.wheel;
        for (const RecordStep& step : sampler_.up_to(clock_.time_s(), pose_, asked)) {
            if (parts_.record != nullptr)
                parts_.record->add(step);
            frame.eyes.push_back(step.position);
        }
        place(frame);
        frames = cut_to_size(std::move(frame));
    }
    std::vector<feed::LedChange>& changes = frames.front().changes;
    changes.insert(changes.begin(), changes_.begin(), changes_.end());
    changes_.clear();
    for (feed::LedFrame& frame : frames) {
        frame.idle = frame.eyes.empty() && frame.changes.empty() && frame.balls.empty() &&
                     frame.bodies.empty() && !frame.blows;
        frame.time_s = clock_.time_s();
        frame.hour = weather_.hour;
        frame.position = pose_.pose.position;
        frame.yaw_deg = pose_.pose.yaw_deg;
        frame.pitch_deg = pose_.pose.pitch_deg;
        frame.roll_deg = pose_.roll_deg;
        frame.fov_deg = pose_.pose.fov_deg;
    }
    return frames;
}

/// A flight that is kept, shown again or led is simulated by its steps, however many fall into a
/// picture: its pictures are then the same whatever their rate. Any other one is simulated once a
/// picture, and no more than a slow machine can.
void Flight::simulate(const std::vector<Camera>& cameras, const Input& input) {
    if (parts_.follow != nullptr)
        return; // it has been, in follow()
    if (by_steps()) {
        for (feed::LedFrame& frame : plan(input)) {
            if (parts_.lead != nullptr)
                parts_.lead->lead(frame); // so that all begin at once
            steps().perform(frame);
        }
        return;
    }
    feed::LedFrame frame;
    place(frame);
    if (!frame.balls.empty())
        field_.set_colliders(frame.balls, frame.time_s);
    if (!frame.bodies.empty())
        field_.set_objects(frame.bodies, frame.time_s);
    if (frame.blows)
        field_.set_blowers(frame.blowers, frame.time_s);
    std::vector<glm::dvec3> eyes;
    for (const Camera& camera : cameras)
        eyes.push_back(eye_of(camera));
    field_.simulate(clock_.time_s(), eyes, render::limits_of(settings_));
}

/// Where the master's frame looks from.
void Flight::see_as(const feed::LedFrame& frame) {
    pose_.pose.position = frame.position;
    pose_.pose.yaw_deg = frame.yaw_deg;
    pose_.pose.pitch_deg = frame.pitch_deg;
    pose_.pose.fov_deg = frame.fov_deg;
    pose_.pose.agl = false;
    pose_.roll_deg = frame.roll_deg;
    weather_.hour = frame.hour;
    for (const feed::LedChange& change : frame.changes)
        if (const MeanWind* const wind = std::get_if<MeanWind>(&change.what))
            weather_.wind = *wind;
    const double dt = frame.time_s - clock_.time_s();
    clock_.set_time(frame.time_s);
    measure_speed({dt, dt});
    seen_ = frame.count;
}

/// Does what the master has done since the last picture, some of it where that is much. False: a
/// picture would be the same as the last.
bool Flight::follow(const Input& input) {
    FollowLink& link = *parts_.follow;
    link.exchange(kWait_s);
    if (link.follower().left())
        next_ = parts_.scene; // read again, and begun with the other flight
    const Clock::time_point begun = Clock::now();
    bool news = false;
    const gl::BreathScope breath([this] { take_breath(); });
    drawing_ = Clock::now();
    for (std::optional<feed::LedFrame> frame; seconds_since(begun) < kCatchUp_s; news = true) {
        frame = link.follower().next();
        if (!frame)
            break;
        steps().perform(*frame);
        see_as(*frame);
    }
    if (const auto frame = link.follower().idle()) {
        see_as(*frame);
        news = true;
    }
    return seen_ && (news || !input.presses.empty() || seconds_since(drawn_) > kStill_s);
}

/// Whether a key is the master's: time, weather, camera.
bool Flight::leave_to_master(Action action) {
    switch (action) {
    case Action::kHelp:
    case Action::kLine:
    case Action::kPanel:
    case Action::kPose:
    case Action::kFlow:
    case Action::kReload:
    case Action::kSequence:
    case Action::kScreenshot:
    case Action::kFullScreen:
    case Action::kQuit:
        return false;
    default:
        return parts_.follow != nullptr;
    }
}

void Flight::tell_master() {
    drawn_ = Clock::now();
    if (parts_.follow == nullptr || !seen_)
        return;
    parts_.follow->follower().drawn(*seen_);
    parts_.follow->exchange(0);
}

std::string Flight::note() const {
    if (parts_.follow != nullptr)
        return parts_.follow->note();
    const std::string led = parts_.lead == nullptr ? "" : parts_.lead->note();
    return led.empty() ? source_.note() : source_.note() + "  |  " + led;
}

} // namespace sward::app
