// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/channels.h"
#include "app/commands.h"
#include "app/devices.h"
#include "app/drive_source.h"
#include "app/flight.h"
#include "app/fly_source.h"
#include "app/io.h"
#include "app/joystick_list.h"
#include "app/lead_links.h"
#include "app/load_screen.h"
#include "app/paths.h"
#include "app/pose_source.h"
#include "app/poses.h"
#include "app/recent_scenes.h"
#include "app/view_scene.h"
#include "app/window.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "gl/breath.h"
#include "gl/context.h"
#include "render/access.h"

namespace sward::app {
namespace {

constexpr double kAwait_s = 0.03; // between two looks for the master's answer

scene::Scene first_scene(const Options& options) {
    return open_scene(options.scene.empty() ? default_scene() : options.scene);
}

WindowPlace place_of(const Options& options, const std::vector<Channel>& channels) {
    if (const glm::ivec2 all = extent_of(channels); !channels.empty())
        return {all.x, all.y, {}};
    return options.window.value_or(WindowPlace{options.frame.width, options.frame.height, {}});
}

/// Checked before the window opens: what is replayed, and that there is room for what is kept.
std::optional<FlightRecord> record_of(const Options& options) {
    if (!options.record.empty())
        base::require_writable(options.record);
    return options.replay.empty() ? std::nullopt : std::optional(read_record(options.replay));
}

/// The eye of a flight that was kept.
class ReplaySource : public PoseSource {
public:
    explicit ReplaySource(const FlightRecord& record) : record_(record) {}
    void advance(ViewPose& pose, const PoseMoment& moment) override {
        pose = record_.pose_at(moment.time_s);
        ended_ = moment.time_s >= record_.end_s();
    }
    [[nodiscard]] std::string note() const override {
        return ended_ ? "replay: ended" : fmt::format("replay: to {:.1f} s", record_.end_s());
    }

private:
    const FlightRecord& record_;
    bool ended_ = false;
};

/// A window that shows one scene after another.
class Viewer {
public:
    explicit Viewer(const Options& options)
        : options_(options), channels_(options.channels.empty() ? std::vector<Channel>{}
                                                                : read_channels(options.channels)),
          record_(record_of(options)), links_(open_feed(options)),
          lead_(options.master ? std::make_unique<LeadLink>(*options.master) : nullptr),
          follow_(options.follow
                      ? std::make_unique<FollowLink>(
                            *options.follow, channels_.empty() ? "" : channels_.front().name)
                      : nullptr),
          devices_(load_device_controls()),
          window_("Sward", place_of(options, channels_), options.debug_gl),
          panel_(window_.handle()) {
        gl::require_gl45();
        window_.use_devices(std::move(devices_));
    }

    /// Shows a scene, from its camera `camera`, and what is asked for next. A scene that was asked
    /// for within the window and fails is told of, and the one before is there again. Throws
    /// Stopped.
    void run(scene::Scene scene, std::string camera) {
        std::optional<scene::Scene> before;
        std::string word;
        while (true) {
            std::optional<scene::Scene> next;
            try {
                next = show(scene, camera, word);
                word.clear();
                before = std::move(scene);
            } catch (const base::Error& error) {
                if (!before || follow_)
                    throw;
                word = error.what();
            } catch (const Error& error) { // of the library's face
                if (!before || follow_)
                    throw;
                word = error.what();
            } catch (const AlreadyReported&) {
                if (!before || follow_)
                    throw;
                word = fmt::format("{}: its grass set could not be baked", scene.file.string());
            }
            if (!word.empty()) {
                base::log_error(word);
                next = std::exchange(before, {});
            }
            if (!next)
                return;
            scene = std::move(*next);
            camera.clear();
        }
    }

private:
    std::optional<scene::Scene> show(scene::Scene& scene, const std::string& camera,
                                     const std::string& word) {
        if (options_.density)
            scene.grass.density = *options_.density;
        if (follow_)
            await_master(scene);
        scene::Pose start = find_camera(scene, camera);
        LoadScreen screen(window_, panel_, scene_title(scene));
        window_.forget_keys();
        render::World world = screen.read(scene);
        world.far = options_.frame.far;
        const scene::PlaceOnEarth on_earth = place_on_earth(world.elevation);
        scene::settle_place(start, on_earth, "--camera");
        const double latitude = world.elevation.origin ? world.elevation.origin->latitude_deg
                                                       : SunDay::kUsualLatitude_deg;
        const std::unique_ptr<PoseSource> source =
            record_ ? std::make_unique<ReplaySource>(*record_)
                    : make_pose_source(
                          options_,
                          {links_, on_earth,
                           links_.out || !options_.drive.empty() ? cover_of(world) : CoverAt()});
        if (lead_)
            lead_->begin(flight_of(scene));
        source->add_objects(world);
        Field field = build(std::move(world), screen);
        if (options_.exit_after == 0)
            note_recent(recent_file(), scene.file);
        std::optional<RecordWriter> writer;
        if (!options_.record.empty())
            writer.emplace(options_.record, scene.file.string(), options_.time_s);
        Flight flight({options_, scene, channels_, start, latitude, window_, panel_, field, *source,
                       word, record_ ? &*record_ : nullptr, writer ? &*writer : nullptr,
                       lead_.get(), follow_.get()});
        return flight.run();
    }

    /// What followers begin with.
    [[nodiscard]] feed::LeadStart flight_of(const scene::Scene& scene) const {
        const scene::WindSpec& wind = scene.wind;
        return {record_ ? record_->start_s : options_.time_s,
                scene.grass.density,
                wind.seed,
                scene_digest(scene.file),
                {scene.sun.azimuth_deg, scene.sun.elevation_deg},
                {wind.speed_mps, wind.direction_deg, wind.gust}};
    }

    /// Until it answers; then the scene begins as its does. Throws Stopped.
    void await_master(scene::Scene& scene) {
        if (follow_->follower().left())
            follow_->follower().begin_again();
        LoadScreen screen(window_, panel_, scene_title(scene));
        for (; !follow_->follower().start(); follow_->exchange(kAwait_s)) {
            screen.show("waiting for the master at " + follow_->address());
            if (window_.asked_to_end())
                throw Stopped{};
        }
        const feed::LeadStart& start = *follow_->follower().start();
        if (start.scene != scene_digest(scene.file))
            base::log_warning("--follow: the master has another scene, or another version of this "
                              "program: pictures may differ");
        scene.wind.seed = start.seed;
        scene.wind.speed_mps = start.wind.speed_mps;
        scene.wind.direction_deg = start.wind.direction_deg;
        scene.wind.gust = start.wind.gust;
        scene.sun = {start.sun.azimuth_deg, start.sun.elevation_deg};
        scene.grass.density = start.density;
    }

    static Field build(render::World world, LoadScreen& screen) {
        const gl::BreathScope breath([&] { screen.show("textures and shaders"); });
        screen.show("textures and shaders");
        Field field = render::Access::field_of(std::move(world));
        static_cast<void>(render::Access::state(field).passes(false));
        return field;
    }

    const Options& options_;
    std::vector<Channel> channels_;
    std::optional<FlightRecord> record_; ///< --replay
    // Before the window: a port in use or a wrong file is told of first.
    FeedLinks links_;
    std::unique_ptr<LeadLink> lead_;
    std::unique_ptr<FollowLink> follow_;
    input::ControlMap devices_;
    Window window_;
    Panel panel_;
};

} // namespace

void run_view(const Options& options) {
    if (options.list_joysticks)
        return list_joysticks();
    scene::Scene scene = first_scene(options);
    static_cast<void>(
        find_camera(scene, options.camera)); // a wrong name is told before the window opens
    if (!options.drive.empty())
        static_cast<void>(find_vehicle(options.drive)); // likewise
    if (!options.fly.empty())
        static_cast<void>(find_aircraft(options.fly));
    gl::DebugMessages messages;
    Viewer viewer(options);
    if (options.debug_gl)
        gl::watch_debug_messages(&messages);
    try {
        viewer.run(std::move(scene), options.camera);
    } catch (const Stopped&) { // as asked
    }
    if (messages.count > 0)
        throw base::Error(
            base::ExitCode::kFailure,
            fmt::format("--debug-gl: found {} OpenGL messages, expected none; the first: {}",
                        messages.count, base::printable(messages.first, 400)));
}

} // namespace sward::app
