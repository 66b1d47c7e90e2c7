// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/options.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace sward::app {

/// Least, middle and greatest of some measurements.
struct Spread {
    double min = 0, median = 0, max = 0;
};
[[nodiscard]] Spread spread_of(std::vector<double> samples);

struct BenchRow {
    std::string scene, variant, pass;
    Spread ms;
    std::uint64_t bytes = 0; ///< of GPU memory that the variant takes
};

/// Draws a frame; its milliseconds by pass, "frame" all, and what it counted. Waits for the GPU
/// before and after.
struct TimedFrame {
    std::map<std::string, double> ms;
    render::FrameStats stats;
};
[[nodiscard]] TimedFrame timed_frame(render::Renderer& renderer, const render::Moment& view,
                                     const render::FrameSettings& settings);

/// A count or share, beside what the paper has for it.
struct BenchFigure {
    std::string scene, variant, name;
    double value = 0;
    double published = -1; ///< below 0: none
};

/// A figure that must not exceed its limit.
struct BenchCheck {
    std::string name;
    double value = 0, limit = 0;
    [[nodiscard]] bool ok() const { return value <= limit; }
};

struct BenchReport {
    std::vector<BenchRow> rows;
    std::vector<BenchFigure> figures;
    std::vector<BenchCheck> checks;
};

/// Suite `wind`: a step of the fluid at 1000 x 1000 beside the published scheme, in turns, and what
/// divergence each leaves. Needs a current context.
void bench_wind(BenchReport& report);

/// Of suite `near`: steps of nature's blades by three programs and by one for all, in turns. Needs
/// a current context.
void bench_physics(BenchReport& report);
/// One of the published scenes, terrains/near/`name`.
[[nodiscard]] scene::Scene near_scene(const char* name);

/// Suite `near`: the published scenes with their tables (J9), physics and culling by the number of
/// blades. Throws Error as loading a scene does. Needs a current context.
void bench_near(BenchReport& report, const Options& options);

/// Suite `tracks`: a step of the published pool of pages (C7), with all of them awake and asleep.
/// Needs a current context.
void bench_tracks(BenchReport& report);

/// Suite `far`: the driver's view with the march and with the planes, in turns, and what its rays
/// read; frames on a small land and on a large one. Throws Error as loading a scene does. Needs a
/// current context.
void bench_far(BenchReport& report, const Options& options);

} // namespace sward::app
