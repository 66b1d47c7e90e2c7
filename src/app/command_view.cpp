// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <imgui.h>

#include "app/arrow_panel.h"
#include "app/capture.h"
#include "app/commands.h"
#include "app/io.h"
#include "app/joystick_list.h"
#include "app/panel.h"
#include "app/pose_source.h"
#include "app/poses.h"
#include "app/window.h"
#include "app/world_loader.h"
#include "base/log.h"
#include "gl/context.h"
#include "render/access.h"
#include "render/renderer.h"

namespace sward::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongestStep = 0.25;   // s: the wind must not leap after a stop
constexpr int kMostWindSteps = 4;       // of the local window in a frame: a slow GPU slows the wind, not the flight
constexpr int kMostPhysicsSteps = 4;    // likewise of the blades
constexpr int kFramesBetweenStats = 15; // reading counters waits for the GPU
constexpr int kLargestSide = 16384;

/// The state of a flight: what the keys, the panel and the clock change from frame to frame.
class Flight {
public:
    Flight(const Options& options, const scene::Scene& scene, const scene::Pose& start, Window& window,
           Field& field, PoseSource& source)
        : options_(options), window_(window), field_(field), source_(source), view_(field), panel_(window.handle()),
          arrows_(scene.wind.arrows, scene.file), settings_(options.frame), pose_{above_datum(start)},
          gpu_(gl::context_info().renderer), time_s_(options.time_s), last_(Clock::now()) {}

    /// Draws until the window is closed, or for options.exit_after frames.
    void run() {
        for (int frame = 0; !window_.closed(); ++frame) {
            if (options_.exit_after > 0 && frame >= options_.exit_after)
                return;
            const Input input = window_.poll(panel_.has_mouse(), panel_.has_keyboard());
            if (input.has(Action::kQuit))
                return;
            const glm::ivec2 size = window_.framebuffer_size();
            if (size.x < 1 || size.y < 1) {
                window_.wait();
                last_ = Clock::now();
                --frame; // not drawn
                continue;
            }
            advance(input);
            draw(size, static_cast<std::uint32_t>(frame));
            act(input);
            present();
        }
    }

private:
    [[nodiscard]] double ground() const {
        return field_.ground_height(pose_.pose.position.x, pose_.pose.position.z);
    }
    [[nodiscard]] scene::Pose above_datum(scene::Pose pose) const {
        if (pose.agl)
            pose.position.y += field_.ground_height(pose.position.x, pose.position.z);
        pose.agl = false;
        return pose;
    }

    void advance(const Input& input) {
        const auto now = Clock::now();
        const double elapsed = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        frame_ms_ = elapsed * 1000;
        const double real =
            options_.fixed_step ? options_.step_s : std::clamp(elapsed, 0.0, kLongestStep);
        const double dt = running_ ? real : 0;
        time_s_ += dt;
        source_.advance(pose_, {input, real, time_s_, dt, land_});
    }

    void draw(glm::ivec2 size, std::uint32_t index) {
        settings_.width = std::min(size.x, kLargestSide);
        settings_.height = std::min(size.y, kLargestSide);
        settings_.most_wind_steps = options_.fixed_step ? 0 : kMostWindSteps;
        settings_.most_physics_steps = options_.fixed_step ? 0 : kMostPhysicsSteps;
        const scene::Pose& at = pose_.pose;
        const Camera camera = camera_of({at.position, at.yaw_deg, at.pitch_deg, pose_.roll_deg, at.fov_deg}, settings_.width, settings_.height);
        const glm::dvec3 eye = eye_of(camera);
        field_.simulate(time_s_, {&eye, 1}, render::limits_of(settings_));
        render::Access::settings(view_) = settings_;
        // A window larger than any picture keeps a rim.
        view_.draw(camera, {settings_.width, settings_.height, 0, 0, std::max(0, size.y - settings_.height)});
        if (index % kFramesBetweenStats == 0)
            stats_ = render::Access::state(view_).stats();
    }

    void present() {
        panel_.draw(
            settings_, running_,
            {stats_, pose_.pose, ground(), source_.note(), frame_ms_, time_s_, gpu_, messages_}, [&] { draw_overlays(); });
        window_.swap();
    }

    void draw_overlays() {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        const Eye eye(pose_.pose, {size.x, size.y});
        if (flow_)
            draw_flow(eye, land_, time_s_);
        if (arrows_.draw(eye, land_, time_s_))
            render::Access::state(field_).sources().set_arrows(arrows_.arrows());
    }

    void act(const Input& input) {
        if (input.has(Action::kFlow))
            flow_ = !flow_;
        if (input.has(Action::kArrows))
            arrows_.shown = !arrows_.shown;
        arrows_.act(input);
        if (input.has(Action::kHelp))
            panel_.help = !panel_.help;
        if (input.has(Action::kPanel))
            panel_.shown = !panel_.shown;
        if (input.has(Action::kPose))
            print_pose();
        if (input.has(Action::kScreenshot))
            take_screenshot();
        if (input.has(Action::kReload))
            reload();
    }

    void print_pose() const {
        scene::Pose above_ground = pose_.pose;
        above_ground.position.y -= ground();
        above_ground.agl = true;
        fmt::print("{}\n", scene::format_pose(above_ground));
        std::fflush(stdout);
    }

    /// A full disk costs the picture, not the flight.
    void take_screenshot() {
        try {
            base::log_info("screenshot: " + capture_screenshot(render::Access::state(view_)).string());
        } catch (const base::Error& error) {
            base::log_error(error.what());
        }
    }

    void reload() {
        messages_.clear();
        render::Access::state(field_).reload(messages_);
        render::Access::state(view_).reload(messages_);
        for (const std::string& message : messages_)
            base::log_warning(message);
        if (messages_.empty())
            base::log_info("shaders reloaded");
    }

    const Options& options_;
    Window& window_;
    Field& field_;
    PoseSource& source_;
    const Land land_{[this](double x, double z) { return field_.ground_height(x, z); },
                     [this](double x, double z) { return field_.wind_at(x, z, time_s_); }};
    View view_;
    Panel panel_;
    ArrowPanel arrows_;
    bool flow_ = false;
    render::FrameSettings settings_;
    render::FrameStats stats_;
    ViewPose pose_;
    std::string gpu_;
    std::vector<std::string> messages_;
    bool running_ = true;
    double time_s_;
    double frame_ms_ = 0;
    Clock::time_point last_;
};

} // namespace

void run_view(const Options& options) {
    if (options.list_joysticks)
        return list_joysticks();
    const scene::Scene scene = load_scene(options);
    scene::Pose start = find_camera(scene, options.camera); // a wrong name is told before the window opens
    const FeedLinks links = open_feed(options);   // a port in use likewise
    gl::DebugMessages messages;
    Window window("Sward", options.frame.width, options.frame.height, options.debug_gl);
    gl::require_gl45();
    if (options.debug_gl)
        gl::watch_debug_messages(&messages);
    render::World world = load_world(scene);
    world.far = options.frame.far;
    const scene::PlaceOnEarth on_earth = place_on_earth(world.elevation);
    scene::settle_place(start, on_earth, "--camera");
    const std::unique_ptr<PoseSource> source = make_pose_source(options, {links, on_earth, links.out ? grass_share_of(world) : GrassShare()});
    Field field = render::Access::field_of(std::move(world));
    window.show();
    {
        Flight flight(options, scene, start, window, field, *source);
        flight.run();
    }
    if (messages.count > 0)
        throw base::Error(
            base::ExitCode::kFailure,
            fmt::format("--debug-gl: found {} OpenGL messages, expected none; the first: {}",
                        messages.count, base::printable(messages.first, 400)));
}

} // namespace sward::app
