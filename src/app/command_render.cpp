// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/camera_file.h"
#include "app/capture.h"
#include "app/channels.h"
#include "app/commands.h"
#include "app/flight_record.h"
#include "app/io.h"
#include "app/output_names.h"
#include "app/poses.h"
#include "app/recorder.h"
#include "app/stats_json.h"
#include "app/world_loader.h"
#include "base/file.h"
#include "base/log.h"
#include "gl/context.h"
#include "render/access.h"
#include "render/renderer.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;

/// Which frames are drawn, and from where: resolved against the scene before any costly work.
struct Shot {
    scene::Pose camera;
    std::optional<scene::Path> path; ///< of the scene; none: `camera` stands
    std::optional<scene::Pose> lod_eye;
    std::optional<Camera> matrices;     ///< in the place of both
    std::optional<FlightRecord> record; ///< likewise, and of the time's steps
    FrameRange frames;
};

Shot plan_shot(const Options& options, const scene::Scene& scene) {
    Shot shot;
    shot.frames = options.frames.value_or(FrameRange{});
    if (options.path.empty())
        shot.camera = find_camera(scene, options.camera);
    else
        shot.path = find_path(scene, options.path);
    shot.lod_eye = options.lod_eye;
    if (!options.camera_matrices.empty())
        shot.matrices = read_camera(options.camera_matrices);
    if (!options.replay.empty())
        shot.record = read_record(options.replay);
    return shot;
}

/// Latitudes and longitudes become x and z, once the terrain is there.
void settle(Shot& shot, const Options& options, const render::World& world) {
    const scene::PlaceOnEarth on_earth = place_on_earth(world.elevation);
    scene::settle_place(shot.camera, on_earth, "--camera");
    if (shot.lod_eye)
        scene::settle_place(*shot.lod_eye, on_earth, "--lod-eye");
    if (shot.path)
        shot.path = find_path(world.scene, options.path);
}

/// Where one frame is seen from, and when.
struct Look {
    Camera camera;
    std::optional<glm::dvec3> lod_eye; ///< another place that tiers are measured from
    double time_s = 0;
};

scene::Pose above_datum(scene::Pose pose, const Field& field) {
    if (pose.agl)
        pose.position.y += field.ground_height(pose.position.x, pose.position.z);
    pose.agl = false;
    return pose;
}

Look look_of(const Shot& shot, const Options& options, const Field& field, int frame) {
    Look look;
    look.time_s = options.time_s + frame * options.step_s;
    if (shot.record) {
        look.time_s = std::max(options.time_s, shot.record->start_s) + frame * options.step_s;
        const ViewPose at = shot.record->pose_at(look.time_s);
        look.camera = camera_of(at, options.frame.width, options.frame.height);
        return look;
    }
    const scene::Pose pose =
        above_datum(shot.path ? scene::sample_path(*shot.path, look.time_s) : shot.camera, field);
    look.camera = shot.matrices
                      ? *shot.matrices
                      : render::camera_of_pose(pose, options.frame.width, options.frame.height);
    if (shot.lod_eye)
        look.lod_eye = above_datum(*shot.lod_eye, field).position;
    return look;
}

void require_silence(const gl::DebugMessages& messages) {
    if (messages.count > 0)
        throw base::Error(
            base::ExitCode::kFailure,
            fmt::format("--debug-gl: found {} OpenGL messages, expected none; the first: {}",
                        messages.count, base::printable(messages.first, 400)));
}

void write_picture(const render::ViewState& drawn, const fs::path& name, const Options& options) {
    if (options.raw) {
        write_raw(drawn.read_picture());
        return;
    }
    make_parent(name);
    capture(drawn, name, options.aovs);
}

/// One picture and its statistics: both or neither.
void write_one(const Options& options, const render::ViewState& view,
               const std::vector<std::string>& stats) {
    std::optional<base::PendingOutput> pending;
    if (!options.stats.empty()) {
        make_parent(options.stats);
        pending.emplace(options.stats, base::PendingOutput::Kind::kFile);
        try {
            base::write_file_atomic(pending->path(), stats.front());
        } catch (const base::Error&) { // it names the temporary
            throw base::input_error(base::ExitCode::kIo, options.stats, 0, "cannot write",
                                    "no room for it", "room for the whole file");
        }
    }
    write_picture(view, options.output, options);
    if (pending)
        pending->commit();
}

void write_sequence_stats(const Options& options, const std::vector<std::string>& stats) {
    if (options.stats.empty())
        return;
    try {
        make_parent(options.stats);
        base::write_file_atomic(options.stats, sequence_json(stats, options.frames->first));
    } catch (const base::Error& error) {
        throw base::Error(error.code(), std::string(error.what()) + "; the pictures are written");
    }
}

/// Before any costly work: tracks need a scene that has some, and a file that ends as what it will
/// be.
void check_tracks(const Options& options, const scene::Scene& scene) {
    for (const auto& [name, file] : {std::pair{"--tracks", &options.tracks},
                                     std::pair{"--save-tracks", &options.save_tracks}}) {
        if (file->empty())
            continue;
        if (!scene.tracks)
            throw base::Error(
                base::ExitCode::kUsage,
                fmt::format("{}: found a scene without [tracks], expected one with it", name));
        if (!is_linear(*file))
            throw base::Error(base::ExitCode::kUsage,
                              fmt::format("{}: found {}, expected the name of an .exr", name,
                                          base::printable(file->native())));
    }
}

void take_tracks(const Options& options, Field& field) {
    if (!options.tracks.empty())
        render::Access::state(field).tracks->begin_with(read_linear(options.tracks),
                                                        base::printable(options.tracks.native()));
}

/// How many pictures a record has where --frames does not say.
FrameRange whole_of(const FlightRecord& record, const Options& options) {
    constexpr int kMostFrames = 999'999;
    const double first = std::max(options.time_s, record.start_s),
                 steps = std::max(0.0, record.end_s() - first) / options.step_s;
    return {0, static_cast<int>(std::min<double>(kMostFrames, std::floor(steps + 1e-6)))};
}

/// One picture of every moment: the only one, or a channel's, with options of its own for it.
struct Screen {
    Options options;
    OutputNames names;
    std::optional<Channel> channel;
    View view;

    Screen(Field& field, Options own, std::optional<Channel> of)
        : options(std::move(own)), names(options), channel(std::move(of)), view(field) {
        render::FrameSettings& settings = render::Access::settings(view);
        settings = options.frame;
        settings.aov = !options.aovs.empty();
    }
    [[nodiscard]] Camera camera(const Look& look) const {
        return channel ? channel_camera(look.camera, *channel) : look.camera;
    }
    [[nodiscard]] const render::ViewState& drawn() { return render::Access::state(view); }
    void draw(const Look& look) {
        render::Access::settings(view).lod_eye = look.lod_eye;
        view.draw(camera(look), {options.frame.width, options.frame.height});
    }
};

Options options_of(const Channel& channel, const Options& options) {
    Options own = options;
    own.output = channel_file(options.output, channel);
    own.frame.width = channel.size.x;
    own.frame.height = channel.size.y;
    return own;
}

/// Every picture's name is looked at before any costly work.
std::vector<Channel> channels_of(const Options& options) {
    if (options.channels.empty()) {
        check_outputs(options);
        return {};
    }
    std::vector<Channel> channels = read_channels(options.channels);
    for (const Channel& channel : channels)
        check_outputs(options_of(channel, options));
    return channels;
}

std::vector<Screen> screens_of(const Options& options, std::vector<Channel> channels,
                               Field& field) {
    std::vector<Screen> screens;
    screens.reserve(std::max<std::size_t>(1, channels.size()));
    if (channels.empty())
        screens.emplace_back(field, options, std::nullopt);
    for (Channel& channel : channels)
        screens.emplace_back(field, options_of(channel, options), std::move(channel));
    return screens;
}

/// The field as it is at a picture's time.
void simulate(const Shot& shot, const Look& look, const std::vector<Screen>& screens, Field& field,
              std::optional<RecordedTime>& steps) {
    const SimulationLimits limits = render::limits_of(screens.front().options.frame);
    if (!shot.record) {
        std::vector<glm::dvec3> eyes;
        for (const Screen& screen : screens)
            eyes.push_back(eye_of(screen.camera(look)));
        field.simulate(look.time_s, eyes, limits);
        return;
    }
    if (!steps)
        steps.emplace(field, limits, shot.record->start_s);
    steps->follow(*shot.record, look.time_s);
}

/// Draws every picture, and writes those of a sequence; returns their statistics, where they are
/// asked for.
std::vector<std::string> draw_all(const Shot& shot, const Options& options, Field& field,
                                  std::vector<Screen>& screens, const gl::DebugMessages& messages) {
    const std::string gpu = gl::context_info().renderer;
    const int count = shot.frames.last - shot.frames.first + 1;
    std::optional<base::Progress> progress;
    if (count > 1)
        progress.emplace("frames", static_cast<std::size_t>(count));
    std::vector<std::string> stats;
    std::optional<RecordedTime> steps;
    for (int frame = shot.frames.first; frame <= shot.frames.last; ++frame) {
        const Look look = look_of(shot, options, field, frame);
        const int times = frame == shot.frames.first ? options.warm + 1 : 1;
        for (int i = 0; i < times; ++i) {
            simulate(shot, look, screens, field, steps);
            for (Screen& screen : screens)
                screen.draw(look);
        }
        if (!options.stats.empty())
            stats.push_back(stats_json(screens.front().drawn().stats(), gpu,
                                       render::Access::settings(screens.front().view)));
        require_silence(messages);
        for (Screen& screen : screens)
            if (options.frames)
                write_picture(screen.drawn(), screen.names.name(frame), screen.options);
        if (progress)
            progress->advance();
    }
    require_silence(messages);
    return stats;
}

/// With --replay and no --frames it is the whole flight.
Options settled(Options options) {
    if (!options.replay.empty() && !options.frames)
        options.frames = whole_of(read_record(options.replay), options);
    return options;
}

} // namespace

void run_render(const Options& given) {
    const Options options = settled(given);
    std::vector<Channel> channels = channels_of(options);
    const scene::Scene scene = load_scene(options);
    for (const Channel& channel : channels)
        check_not_inputs(options_of(channel, options), scene);
    check_not_inputs(options, scene);
    check_tracks(options, scene);
    Shot shot = plan_shot(options, scene);

    gl::DebugMessages messages;
    const gl::HeadlessContext context(options.debug_gl);
    if (options.debug_gl)
        gl::watch_debug_messages(&messages);
    render::World world = load_world(scene);
    world.far = options.frame.far;
    settle(shot, options, world);
    Field field = render::Access::field_of(std::move(world));
    std::vector<Screen> screens = screens_of(options, std::move(channels), field);
    take_tracks(options, field);
    render::Access::inside(field).wait_in_passes = options.frame.wait_in_passes;
    const std::vector<std::string> stats = draw_all(shot, options, field, screens, messages);
    if (!options.save_tracks.empty()) {
        make_parent(options.save_tracks);
        write_linear(options.save_tracks, render::Access::state(field).tracks->picture());
    }
    if (options.frames)
        write_sequence_stats(options, stats);
    else
        for (Screen& screen : screens)
            write_one(screen.options, screen.drawn(), stats);
}

} // namespace sward::app
