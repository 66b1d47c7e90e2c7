// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "app/bench.h"
#include "app/paths.h"
#include "app/poses.h"
#include "app/world_loader.h"
#include "shared/bindings.h"
#include "shared/blade_pages.h"

namespace sward::app {
namespace {

constexpr int kFrames = 2; // that count, after one that builds caches
constexpr glm::ivec2 kSize{512, 384};
constexpr int kTurns = 4; // of each number of blades
constexpr double kStep_s = 1.0 / 60;
constexpr double kLinear = 1.5; // of the time a blade: more blades leave the processor's cache,
                                // which in software costs a quarter to a third
constexpr double kRotorStarted_s = 2;     // the helicopter's wind has come down and spread by then
constexpr std::size_t kPool = 192u << 20; // states of 12 million blades
constexpr blades::CullTests kAllTests{true, true, true, true}, kNoTests{false, false, false, false};
// Bytes that a step moves: a record read, a state read and written; a patch's page, its own state
// twice, its lists and its number twice.
constexpr double kMovedByStep =
    64 + 2 * 16 +
    (sizeof(shared::BladePage) + 2.0 * sizeof(shared::PatchState) + 8 + 8) / CULL_GROUP;

/// J9's figures of a scene, in its order.
struct Published {
    double frame_ms, physics_ms, physics_none_ms, visibility_ms, drawing_ms, drawn, culled,
        orientation, frustum, distance, occlusion;
    double off_frame_ms, off_drawn, off_drawing_ms;
};
constexpr double kNone = -1;
constexpr Published kNature{8.130, 0.547, 0.041, 1.401, 2.057,    43128,  125205,
                            44695, 79533, 46965, 6025,  1e3 / 78, 168333, 3.872};
constexpr Published kHelicopter{1e3 / 56, 1.421, kNone, 6.817, 5.471,    165135, 338247,
                                kNone,    kNone, kNone, kNone, 1e3 / 35, 503382, 9.149};

/// A scene that is drawn again and again.
class Stage {
public:
    /// `start_s`: of the first frame.
    Stage(scene::Scene scene, const Options& options, const char* camera = "default",
          double start_s = 0)
        : renderer_(load_world(scene)),
          size_(options.bench_size.x > 0 ? options.bench_size : kSize),
          frame_(static_cast<int>(std::lround(start_s / kStep_s))) {
        small(false);
        settings_.simulated_radius_m = 1e6;
        settings_.most_simulated_bytes = kPool;
        settings_.wait_in_passes = true;
        view_.pose = renderer_.above_datum(find_camera(scene, camera));
        view_.lod_pose = view_.pose;
    }
    /// Draws a frame, a step later than the one before where `step` says so; returns its
    /// milliseconds by pass, "frame" all.
    std::map<std::string, double> draw(const blades::CullTests& tests, bool step) {
        frame_ += step ? 1 : 0;
        view_.time_s = frame_ * kStep_s;
        settings_.cull = tests;
        TimedFrame frame = timed_frame(renderer_, view_, settings_);
        stats_ = std::move(frame.stats);
        std::map<std::string, double> ms = std::move(frame.ms);
        ms["visibility"] = ms["depth pyramid"] + ms["cull blades"];
        return ms;
    }
    /// A small picture from now on, or one of the asked size: for what does not hang on the
    /// drawing.
    void small(bool is_small) {
        settings_.width = is_small ? 64 : size_.x;
        settings_.height = is_small ? 48 : size_.y;
        settings_.samples = is_small ? 1 : 4;
    }
    render::Renderer& renderer() { return renderer_; }
    [[nodiscard]] double time_s() const { return view_.time_s; }
    [[nodiscard]] const render::FrameStats& stats() const { return stats_; }

private:
    render::Renderer renderer_;
    glm::ivec2 size_;
    render::FrameSettings settings_;
    render::Moment view_;
    render::FrameStats stats_;
    int frame_;
};

/// Times of frames by pass.
class Times {
public:
    void add(const std::map<std::string, double>& ms) {
        for (const auto& [name, value] : ms)
            samples_[name].push_back(value);
    }
    [[nodiscard]] Spread of(const std::string& pass) const {
        const auto found = samples_.find(pass);
        return found == samples_.end() ? Spread{} : spread_of(found->second);
    }

private:
    std::map<std::string, std::vector<double>> samples_;
};

std::uint64_t held_bytes(const render::FrameStats& stats) {
    return stats.surface_bytes + stats.physics_bytes;
}

/// What a scene's table is written into.
struct Table {
    BenchReport& report;
    std::string scene;
    void time(const char* variant, const char* column, Spread ms, double published,
              std::uint64_t bytes = 0) const {
        report.rows.push_back({scene, variant, column, ms, bytes});
        if (published >= 0)
            report.figures.push_back(
                {scene, variant, std::string(column) + " ms", ms.median, published});
    }
    void count(const char* variant, const char* name, double value,
               double published = kNone) const {
        report.figures.push_back({scene, variant, name, value, published});
    }
};

std::uint64_t culled(const render::FrameStats& s) {
    return s.culled_by_frustum + s.culled_by_orientation + s.culled_by_distance +
           s.culled_by_occlusion;
}

/// Each test alone, on a frame whose blades stand still.
void each_alone(Stage& stage, const Table& table, const Published& published) {
    struct One {
        const char* name;
        blades::CullTests tests;
        double published;
    };
    for (const One& one : {One{"orientation", {false, true, false, false}, published.orientation},
                           One{"frustum", {true, false, false, false}, published.frustum},
                           One{"distance", {false, false, true, false}, published.distance},
                           One{"occlusion", {false, false, false, true}, published.occlusion}}) {
        stage.small(!one.tests.occlusion); // which alone sees pixels
        stage.draw(one.tests, false);
        table.count("test alone", one.name, static_cast<double>(culled(stage.stats())),
                    one.published);
    }
}

/// Steps of a scene and of the same without colliders, in turns.
void physics_of(Stage& stage, Stage& still, const Table& table, const Published& published) {
    Times some, none;
    for (Stage* one : {&stage, &still}) {
        one->small(true);
        one->draw(kAllTests, true);
    }
    for (int i = 0; i < kTurns; ++i) {
        some.add(stage.draw(kAllTests, true));
        none.add(still.draw(kAllTests, true));
    }
    stage.small(false);
    table.time("with spheres", "physics", some.of("physics"), published.physics_ms,
               stage.stats().physics_bytes);
    table.time("no spheres", "physics", none.of("physics"), published.physics_none_ms,
               still.stats().physics_bytes);
    table.count("with spheres", "spheres a patch",
                static_cast<double>(stage.stats().sphere_pairs) * CULL_GROUP /
                    static_cast<double>(stage.stats().blades_simulated));
    table.report.checks.push_back({"near: physics with " + table.scene + "'s spheres over none",
                                   some.of("physics").min / none.of("physics").min, 1.5});
}

/// The columns of J9 with all tests on and off.
void table_of(Stage& stage, const Table& table, const Published& published) {
    stage.draw(kAllTests, true);
    Times on, off;
    for (int i = 0; i < kFrames; ++i)
        on.add(stage.draw(kAllTests, true));
    const render::FrameStats stats = stage.stats();
    off.add(stage.draw(kNoTests, false));
    const render::FrameStats off_stats = stage.stats();
    table.time("culling on", "frame", on.of("frame"), published.frame_ms, stats.gpu_bytes);
    table.time("culling on", "physics", on.of("physics"), published.physics_ms,
               stats.physics_bytes);
    table.time("culling on", "visibility", on.of("visibility"), published.visibility_ms);
    table.time("culling on", "drawing", on.of("draw blades"), published.drawing_ms);
    table.count("culling on", "blades", static_cast<double>(stats.blades_simulated));
    table.count("culling on", "of visible patches", static_cast<double>(stats.blades_considered),
                published.drawn + published.culled);
    table.count("culling on", "drawn", static_cast<double>(stats.blades_drawn), published.drawn);
    table.count("culling on", "culled", static_cast<double>(culled(stats)), published.culled);
    table.count("culling on", "by frustum", static_cast<double>(stats.culled_by_frustum),
                published.frustum);
    table.count("culling on", "by orientation", static_cast<double>(stats.culled_by_orientation),
                published.orientation);
    table.count("culling on", "by distance", static_cast<double>(stats.culled_by_distance),
                published.distance);
    table.count("culling on", "by occlusion", static_cast<double>(stats.culled_by_occlusion),
                published.occlusion);
    each_alone(stage, table, published);
    table.time("culling off", "frame", off.of("frame"), published.off_frame_ms);
    table.time("culling off", "drawing", off.of("draw blades"), published.off_drawing_ms);
    table.count("culling off", "drawn", static_cast<double>(off_stats.blades_drawn),
                published.off_drawn);
    table.count("memory", "bytes held a blade",
                static_cast<double>(held_bytes(stats)) /
                    static_cast<double>(stats.blades_simulated));
}

/// Ten thousand spheres of 10 cm in four layers over the level ground.
void ten_thousand(Stage& stage, const Table& table) {
    std::vector<blades::HostSphere> spheres;
    for (int n = 0; n < 10'000; ++n)
        spheres.push_back(
            {{0.12 * (n / 4 % 50) - 3, 0.1 + 0.12 * (n % 4), 0.12 * (n / 200) + 3}, 0.1});
    stage.renderer().set_colliders(std::move(spheres), stage.time_s());
    stage.small(true);
    stage.draw(kAllTests, true);
    Times times;
    times.add(stage.draw(kAllTests, true));
    table.time("10,000 more", "physics", times.of("physics"), kNone);
    table.count("10,000 more", "spheres a patch",
                static_cast<double>(stage.stats().sphere_pairs) * CULL_GROUP /
                    static_cast<double>(stage.stats().blades_simulated));
    stage.renderer().set_colliders({}, stage.time_s());
}

void nature(BenchReport& report, const Options& options) {
    scene::Scene scene = near_scene("nature");
    Stage stage(scene, options);
    scene.objects.clear();
    Stage still(std::move(scene), options);
    const Table table{report, "nature"};
    physics_of(stage, still, table, kNature);
    table_of(stage, table, kNature);
    const render::FrameStats& stats = stage.stats();
    report.checks.push_back(
        {"near: nature, bytes held a blade",
         static_cast<double>(held_bytes(stats)) / static_cast<double>(stats.blades_simulated), 96});
    stage.small(false);
    stage.draw(kAllTests, false);
    report.checks.push_back(
        {"near: nature, drawn of visible patches' blades",
         static_cast<double>(stats.blades_drawn) / static_cast<double>(stats.blades_considered),
         0.3});
    ten_thousand(stage, table);
}

/// Physics and culling of the hills with ever more blades, from above, where all are in sight; the
/// counts in turns, so that what else the machine does hits all.
void scaling(BenchReport& report, const Options& options) {
    std::vector<double> counts = {397'881, 900'000};
    if (options.bench_full)
        counts.push_back(7'000'000);
    std::vector<std::unique_ptr<Stage>> stages;
    std::vector<Times> times(counts.size());
    for (const double count : counts) {
        scene::Scene scene = near_scene("nature");
        scene.objects.clear();
        scene.surface_grass.density_per_m2 *= count / counts.front();
        stages.push_back(std::make_unique<Stage>(std::move(scene), options, "above"));
        stages.back()->small(true);
        stages.back()->draw(kAllTests, true);
    }
    for (int i = 0; i < kTurns; ++i)
        for (std::size_t n = 0; n < stages.size(); ++n)
            times[n].add(stages[n]->draw(kAllTests, true));
    std::vector<double> physics_ns, culling_ns;
    for (std::size_t n = 0; n < stages.size(); ++n) {
        const render::FrameStats& stats = stages[n]->stats();
        const auto blades = static_cast<double>(stats.blades_simulated);
        const Table table{report, fmt::format("{:.0f} blades", blades)};
        table.time("from above", "physics", times[n].of("physics"), kNone, held_bytes(stats));
        table.time("from above", "culling", times[n].of("cull blades"), kNone);
        physics_ns.push_back(1e6 * times[n].of("physics").min / blades);
        culling_ns.push_back(1e6 * times[n].of("cull blades").min /
                             static_cast<double>(stats.blades_considered));
        table.count("from above", "physics ns a blade", physics_ns.back());
        table.count("from above", "culling ns a blade", culling_ns.back());
        table.count("from above", "bytes held a blade",
                    static_cast<double>(held_bytes(stats)) / blades);
        table.count("from above", "bytes a step moves a blade", kMovedByStep);
        table.count("from above", "physics GB/s", kMovedByStep / physics_ns.back());
    }
    report.checks.push_back({"near: physics a blade, most blades over fewest",
                             physics_ns.back() / physics_ns.front(), kLinear});
    report.checks.push_back({"near: culling a blade, most blades over fewest",
                             culling_ns.back() / culling_ns.front(), kLinear});
}

} // namespace

scene::Scene near_scene(const char* name) {
    Options options;
    options.scene = data_directory() / "terrains" / "near" / name;
    return load_scene(options);
}

void bench_near(BenchReport& report, const Options& options) {
    bench_physics(report);
    nature(report, options);
    {
        Stage stage(near_scene("helicopter"), options, "default", kRotorStarted_s);
        table_of(stage, {report, "helicopter"}, kHelicopter);
    }
    scaling(report, options);
}

} // namespace sward::app
