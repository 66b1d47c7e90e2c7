// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/capture.h"
#include "app/commands.h"
#include "app/io.h"
#include "app/output_names.h"
#include "app/poses.h"
#include "app/stats_json.h"
#include "app/world_loader.h"
#include "base/file.h"
#include "base/log.h"
#include "gl/context.h"

namespace sward::app {
namespace {

/// Which frames are drawn, and from where: resolved against the scene before any costly work.
struct Shot {
    scene::Pose camera;
    std::optional<scene::Path> path; ///< of the scene; none: `camera` stands
    std::optional<scene::Pose> lod_eye;
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

render::View view_of(const Shot& shot, const Options& options, const render::Renderer& renderer,
                     int frame) {
    render::View view;
    view.time_s = options.time_s + frame * options.step_s;
    view.frame_index = options.frame_index + static_cast<std::uint32_t>(frame - shot.frames.first);
    const scene::Pose pose = shot.path ? scene::sample_path(*shot.path, view.time_s) : shot.camera;
    view.pose = renderer.above_datum(pose);
    view.lod_pose = view.pose;
    if (shot.lod_eye) {
        view.lod_pose = renderer.above_datum(*shot.lod_eye);
        view.lod_pose.fov_deg = view.pose.fov_deg; // an eye has no lens of its own
    }
    return view;
}

void require_silence(const gl::DebugMessages& messages) {
    if (messages.count > 0)
        throw base::Error(
            base::ExitCode::kFailure,
            fmt::format("--debug-gl: found {} OpenGL messages, expected none; the first: {}",
                        messages.count, base::printable(messages.first, 400)));
}

/// One picture and its statistics: both or neither.
void write_one(const Options& options, render::Renderer& renderer, const std::vector<std::string>& stats) {
    std::optional<base::PendingOutput> pending;
    if (!options.stats.empty()) {
        make_parent(options.stats);
        pending.emplace(options.stats, base::PendingOutput::Kind::kFile);
        try {
            base::write_file_atomic(pending->path(), stats.front());
        } catch (const base::Error&) { // it names the temporary
            throw base::input_error(base::ExitCode::kIo, options.stats, 0, "cannot write", "no room for it", "room for the whole file");
        }
    }
    capture(renderer, options.output, options.aovs);
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

} // namespace

void run_render(const Options& options) {
    check_outputs(options);
    const scene::Scene scene = load_scene(options);
    check_not_inputs(options, scene);
    Shot shot = plan_shot(options, scene);

    gl::DebugMessages messages;
    const gl::HeadlessContext context(options.debug_gl);
    if (options.debug_gl)
        gl::watch_debug_messages(&messages);
    render::World world = load_world(scene);
    world.far = options.frame.far;
    settle(shot, options, world);
    render::Renderer renderer(std::move(world));

    const OutputNames names(options);
    const std::string gpu = gl::context_info().renderer;
    const int count = shot.frames.last - shot.frames.first + 1;
    std::optional<base::Progress> progress;
    if (count > 1)
        progress.emplace("frames", static_cast<std::size_t>(count));
    render::FrameSettings settings = options.frame;
    settings.aov = !options.aovs.empty();
    std::vector<std::string> stats;
    for (int frame = shot.frames.first; frame <= shot.frames.last; ++frame) {
        const render::View view = view_of(shot, options, renderer, frame);
        const int times = frame == shot.frames.first ? options.warm + 1 : 1;
        for (int i = 0; i < times; ++i)
            renderer.draw(view, settings);
        if (!options.stats.empty())
            stats.push_back(stats_json(renderer.stats(), gpu, settings));
        require_silence(messages);
        make_parent(names.name(frame));
        if (options.frames)
            capture(renderer, names.name(frame), options.aovs);
        if (progress)
            progress->advance();
    }
    require_silence(messages);
    if (options.frames)
        write_sequence_stats(options, stats);
    else
        write_one(options, renderer, stats);
}

} // namespace sward::app
