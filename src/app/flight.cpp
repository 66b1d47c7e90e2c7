// SPDX-License-Identifier: Apache-2.0
#include "app/flight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/lead_links.h"
#include "app/paths.h"
#include "app/recent_scenes.h"
#include "app/view_scene.h"
#include "base/error.h"
#include "base/log.h"
#include "gl/context.h"
#include "render/access.h"
#include "render/renderer.h"

namespace sward::app {
namespace {

constexpr double kSpeedFade_s = 0.2; // of the speed that is shown

/// Of the scene and its pose: `sward view` then names both in its messages.
std::vector<std::string> camera_names(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const auto& [name, pose] : scene.cameras)
        names.push_back(name);
    return names;
}

bool same(const MeanWind& a, const MeanWind& b) {
    return a.speed_mps == b.speed_mps && a.direction_deg == b.direction_deg && a.gust == b.gust;
}

/// Simulated time of the first step.
double begin_of(const FlightParts& parts) {
    return parts.follow != nullptr ? parts.follow->follower().start().value().start_s
                                   : parts.options.time_s;
}

} // namespace

Flight::Flight(const FlightParts& parts)
    : parts_(parts), options_(parts.options), window_(parts.window), panel_(parts.panel),
      field_(parts.field), source_(parts.source),
      clock_(parts.replay != nullptr ? std::max(options_.time_s, parts.replay->start_s)
                                     : options_.time_s,
             options_.step_s, options_.fixed_step ? std::optional(options_.step_s) : std::nullopt),
      arrows_(parts.scene.wind.arrows, parts.scene.file), weather_(parts.scene, parts.latitude_deg),
      settings_(options_.frame), pose_{above_datum(parts.start)}, gpu_(gl::context_info().renderer),
      cameras_(camera_names(parts.scene)), recent_(read_recent(recent_file())),
      sampler_(begin_of(parts)), before_(pose_.pose.position), last_(Clock::now()) {
    for (std::size_t i = 0; i < std::max<std::size_t>(1, parts.channels.size()); ++i)
        views_.emplace_back(field_);
    say(parts.word);
}

std::optional<scene::Scene> Flight::run() {
    for (int frame = 0; !window_.closed() && !next_; ++frame) {
        if (options_.exit_after > 0 && frame >= options_.exit_after)
            break;
        const Input input = window_.poll(panel_.has_mouse(), panel_.has_keyboard());
        if (input.has(Action::kQuit))
            break;
        const glm::ivec2 size = window_.framebuffer_size();
        if (size.x < 1 || size.y < 1) {
            window_.wait();
            last_ = Clock::now();
            --frame; // not drawn
            continue;
        }
        for (const Press& press : input.presses)
            act(press);
        arrows_.act(input);
        if (parts_.follow != nullptr && !follow(input)) {
            --frame; // not drawn
            continue;
        }
        const double elapsed = seconds_since(last_);
        last_ = Clock::now();
        if (frame > 0)
            times_.add(elapsed * 1000);
        frame_ms_ = elapsed * 1000;
        if (parts_.follow == nullptr)
            advance(input, elapsed);
        draw(size, input);
        // What is to be seen in a picture waits until there is one.
        if (input.has(Action::kScreenshot))
            take_screenshot();
        if (sequence_)
            add_to_sequence();
        present();
        tell_master();
        if (const auto dropped = window_.take_dropped())
            consider(*dropped);
    }
    return std::move(next_);
}

double Flight::ground() const {
    return field_.ground_height(pose_.pose.position.x, pose_.pose.position.z);
}

scene::Pose Flight::above_datum(scene::Pose pose) const {
    if (pose.agl)
        pose.position.y += field_.ground_height(pose.position.x, pose.position.z);
    pose.agl = false;
    return pose;
}

void Flight::advance(const Input& input, double elapsed_s) {
    const SimClock::Tick tick = clock_.tick(elapsed_s);
    if (parts_.replay != nullptr && clock_.time_s() >= parts_.replay->end_s()) {
        clock_.set_time(parts_.replay->end_s());
        clock_.pause();
    }
    source_.advance(pose_, {input, tick.real_s, clock_.time_s(), tick.dt_s, land_});
    measure_speed(tick);
}

void Flight::measure_speed(const SimClock::Tick& tick) {
    const double dt = source_.in_real_time() ? tick.real_s : tick.dt_s;
    const glm::dvec3 way = pose_.pose.position - before_;
    before_ = pose_.pose.position;
    if (dt > 0)
        speed_mps_ += (glm::length(way) / dt - speed_mps_) * std::min(1.0, dt / kSpeedFade_s);
}

std::string Flight::line() const {
    CockpitFacts facts;
    facts.speed_mps = source_.speed_mps().value_or(speed_mps_);
    facts.above_ground_m = pose_.pose.position.y - ground();
    facts.heading_deg = pose_.pose.yaw_deg;
    facts.p50_ms = times_.percentile(0.5);
    facts.p99_ms = times_.percentile(0.99);
    facts.living = stats_.blades_simulated;
    facts.drawn = stats_.blades_drawn;
    facts.marched = stats_.shell_fragments + stats_.slice_fragments;
    facts.time_s = clock_.time_s();
    facts.hour = hour_text(weather_.hour);
    facts.paused = clock_.paused();
    facts.rate = clock_.rate();
    facts.note = note();
    return cockpit_line(facts);
}

void Flight::act(const Press& press) {
    if (leave_to_master(press.action))
        return say("the master flies");
    switch (press.action) {
    case Action::kPause:
        clock_.toggle_pause();
        break;
    case Action::kStep:
        clock_.single_step();
        break;
    case Action::kSlower:
        clock_.slower();
        break;
    case Action::kFaster:
        clock_.faster();
        break;
    case Action::kRealTime:
        clock_.real_time();
        break;
    case Action::kCamera:
        go_to_camera(press.number);
        break;
    case Action::kPose:
        print_pose();
        break;
    case Action::kReload:
        reload();
        break;
    case Action::kSequence:
        toggle_sequence();
        break;
    default:
        act_on_view(press);
    }
    Weather wanted = weather_;
    wanted.act(press.action);
    set_weather(wanted);
}

void Flight::act_on_view(const Press& press) {
    if (!parts_.channels.empty() &&
        (press.action == Action::kFlow || press.action == Action::kArrows))
        return say("the wind is not drawn over channels");
    switch (press.action) {
    case Action::kFlow:
        flow_ = !flow_;
        break;
    case Action::kArrows:
        arrows_.shown = !arrows_.shown;
        break;
    case Action::kHelp:
        panel_.help = !panel_.help;
        break;
    case Action::kLine:
        line_ = !line_;
        break;
    case Action::kPanel:
        panel_.shown = !panel_.shown;
        break;
    case Action::kRecent:
        panel_.recent = !panel_.recent;
        break;
    case Action::kFullScreen:
        window_.toggle_full_screen();
        break;
    default:
        break;
    }
}

void Flight::set_weather(const Weather& wanted) {
    if (parts_.follow != nullptr)
        return; // the master's
    if (wanted.hour != weather_.hour)
        change(wanted.sun());
    if (!same(wanted.wind, weather_.wind))
        change(wanted.wind);
    weather_ = wanted;
}

void Flight::go_to_camera(int number) {
    const auto index = static_cast<std::size_t>(number);
    if (index >= cameras_.size()) {
        say(fmt::format("no camera {}: the scene has {}", number + 1, cameras_.size()));
        return;
    }
    // The field's own scene: in it, places on Earth have become x and z.
    pose_ = {above_datum(render::Access::state(field_).world.scene.cameras.at(cameras_[index]))};
    before_ = pose_.pose.position;
    say(cameras_[index]);
}

void Flight::print_pose() const {
    scene::Pose above_ground = pose_.pose;
    above_ground.position.y -= ground();
    above_ground.agl = true;
    fmt::print("{}\n", scene::format_pose(above_ground));
    std::fflush(stdout);
}

/// A full disk costs the picture, not the flight.
void Flight::take_screenshot() {
    try {
        for (View& view : views_) {
            say("screenshot: " + capture_screenshot(render::Access::state(view)).string());
            base::log_info(word_);
        }
    } catch (const base::Error& error) {
        base::log_error(error.what());
        say(error.what());
    }
}

void Flight::toggle_sequence() {
    if (sequence_) {
        say(fmt::format("sequence: {} pictures in {}", sequence_->count(),
                        sequence_->folder().string()));
        base::log_info(word_);
        sequence_.reset();
        return;
    }
    try {
        sequence_.emplace();
        say("sequence: every picture goes to " + sequence_->folder().string());
    } catch (const base::Error& error) {
        base::log_error(error.what());
        say(error.what());
    }
}

void Flight::add_to_sequence() {
    try {
        for (View& view : views_)
            sequence_->add(render::Access::state(view));
    } catch (const base::Error& error) { // what is there stays
        base::log_error(error.what());
        say(error.what());
        sequence_.reset();
    }
}

void Flight::reload() {
    messages_.clear();
    render::Access::state(field_).reload(messages_);
    for (View& view : views_)
        render::Access::state(view).reload(messages_);
    for (const std::string& message : messages_)
        base::log_warning(message);
    if (messages_.empty()) {
        base::log_info("shaders reloaded");
        say("shaders reloaded");
    }
}

/// A scene that cannot be read is told of, and the flight goes on.
void Flight::consider(const std::filesystem::path& scene) {
    if (by_steps() || parts_.follow != nullptr) {
        say("a record is of one scene, and so is what followers see: another one is not opened "
            "meanwhile");
        return;
    }
    try {
        next_ = open_scene(scene);
    } catch (const base::Error& error) {
        base::log_error(error.what());
        say(error.what());
    }
}

void Flight::say(std::string word) {
    word_ = base::printable(word, 300);
    said_ = Clock::now();
}

} // namespace sward::app
