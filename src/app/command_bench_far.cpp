// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>

#include "app/bench.h"
#include "app/paths.h"
#include "app/poses.h"
#include "app/world_loader.h"

namespace sward::app {
namespace {

constexpr glm::ivec2 kSize{1280, 720};
constexpr int kTurns = 3;                // of each scheme
constexpr double kShareOfPlanes = 0.5;   // of a frame's time
constexpr double kMostReads = 24;        // texels a pixel that the march covers
constexpr double kMostSelection_ms = 20; // on the CPU, of what a frame chooses to draw
constexpr double kMoreLand = 1.1;        // of a frame's time, a thousand times the land
constexpr double kMoreSpacing_m = 16;
constexpr int kSmallLand = 63, kLargeLand = 1977; // posts a side: 1 and 1000 square kilometres

/// The driver's view of a world, drawn again and again.
class Driver {
public:
    Driver(render::World world, const render::FrameSettings& settings)
        : renderer_((world.far = settings.far, std::move(world))), settings_(settings) {}
    void stand(const scene::Pose& pose) {
        view_.pose = renderer_.above_datum(pose);
        view_.lod_pose = view_.pose;
    }
    /// Milliseconds by pass; "frame": all. The first frame makes caches.
    std::map<std::string, double> draw() {
        view_.time_s += 1.0 / 60;
        TimedFrame frame = timed_frame(renderer_, view_, settings_);
        stats_ = std::move(frame.stats);
        return frame.ms;
    }
    [[nodiscard]] const render::FrameStats& stats() const { return stats_; }
    render::FrameSettings& settings() { return settings_; }

private:
    render::Renderer renderer_;
    render::FrameSettings settings_;
    render::Moment view_;
    render::FrameStats stats_;
};

using Times = std::map<std::string, std::vector<double>>;

void add(Times& times, const std::map<std::string, double>& ms) {
    for (const auto& [name, value] : ms)
        times[name].push_back(value);
}

void report_times(BenchReport& report, const char* scene, const char* variant, const Times& times,
                  std::uint64_t bytes) {
    for (const auto& [pass, samples] : times)
        report.rows.push_back(
            {scene, variant, pass, spread_of(samples), pass == "frame" ? bytes : 0});
}

scene::Scene jacksboro() {
    Options options;
    options.scene = data_directory() / "terrains" / "jacksboro";
    return load_scene(options);
}

render::FrameSettings settings_of(const Options& options, render::FarScheme far) {
    render::FrameSettings settings;
    const glm::ivec2 size = options.bench_size.x > 0 ? options.bench_size : kSize;
    settings.width = size.x;
    settings.height = size.y;
    settings.far = far;
    settings.wait_in_passes = true;
    return settings;
}

void schemes(BenchReport& report, const Options& options) {
    const scene::Scene scene = jacksboro();
    const scene::Pose pose = find_camera(scene, "road");
    Driver march(load_world(scene), settings_of(options, render::FarScheme::kMarch));
    Driver planes(load_world(scene), settings_of(options, render::FarScheme::kPlanes));
    Driver published(load_world(scene), settings_of(options, render::FarScheme::kPublished));
    Times marched, drawn, as_published;
    for (Driver* driver : {&march, &planes, &published}) {
        driver->stand(pose);
        driver->draw();
    }
    for (int i = 0; i < kTurns; ++i) {
        add(marched, march.draw());
        add(drawn, planes.draw());
        add(as_published, published.draw());
    }
    report_times(report, "driver's view", "march", marched, march.stats().gpu_bytes);
    report_times(report, "driver's view", "planes", drawn, planes.stats().gpu_bytes);
    report_times(report, "driver's view", "published", as_published, published.stats().gpu_bytes);
    report.checks.push_back({"far: a frame of the march over one of the planes",
                             spread_of(marched["frame"]).min / spread_of(drawn["frame"]).min,
                             kShareOfPlanes});
    report.checks.push_back(
        {"far: selection on the CPU, ms",
         spread_of(marched["select blocks"]).min + spread_of(marched["select blades"]).min,
         kMostSelection_ms});
    march.settings().count_steps = true;
    march.draw();
    const render::FrameStats& stats = march.stats();
    const auto pixels = static_cast<double>(stats.shell_fragments + stats.slice_fragments);
    report.figures.push_back({"driver's view", "march", "pixels covered", pixels});
    report.figures.push_back({"driver's view", "march", "steps a pixel",
                              static_cast<double>(stats.march_steps) / pixels});
    report.checks.push_back({"far: texels read a pixel covered",
                             static_cast<double>(stats.march_reads) / pixels, kMostReads});
}

/// Gentle hills, so many posts a side.
render::World hills(int posts) {
    render::World world = load_world(jacksboro());
    world.mask = {};
    scene::Heightfield land{posts, posts, {kMoreSpacing_m, kMoreSpacing_m}, {}, {}};
    for (int row = 0; row < posts; ++row)
        for (int column = 0; column < posts; ++column)
            land.metres.push_back(static_cast<float>(20 * std::sin(0.11 * (column - posts / 2)) *
                                                     std::cos(0.07 * (row - posts / 2))));
    world.elevation = std::move(land);
    return world;
}

void lands(BenchReport& report, const Options& options) {
    render::FrameSettings settings = settings_of(options, render::FarScheme::kMarch);
    scene::Pose pose;
    pose.position = {3, 1.7, 5};
    pose.agl = true;
    pose.pitch_deg = -25; // the same pixels see grass on both
    Driver small(hills(kSmallLand), settings), large(hills(kLargeLand), settings);
    Times on_small, on_large;
    for (Driver* driver : {&small, &large}) {
        driver->stand(pose);
        driver->draw();
    }
    for (int i = 0; i < kTurns; ++i) {
        add(on_small, small.draw());
        add(on_large, large.draw());
    }
    report_times(report, "hills", "1 km2", on_small, small.stats().gpu_bytes);
    report_times(report, "hills", "1000 km2", on_large, large.stats().gpu_bytes);
    report.checks.push_back({"far: a frame on 1000 km2 over one on 1",
                             spread_of(on_large["frame"]).min / spread_of(on_small["frame"]).min,
                             kMoreLand});
}

} // namespace

void bench_far(BenchReport& report, const Options& options) {
    schemes(report, options);
    lands(report, options);
}

} // namespace sward::app
