// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>

#include <epoxy/gl.h>

#include "app/bench.h"
#include "gl/memory.h"
#include "shared/bindings.h"
#include "wind/fluid.h"
#include "wind/gust_spectrum.h"
#include "wind/published_scheme.h"

namespace sward::app {
namespace {

constexpr int kCells = 1000;
constexpr int kMargin = 64; // cells at the rim that no figure counts: the two treat it differently
constexpr int kWarm = 8;    // steps before the first that counts
constexpr int kRounds = 9;  // of each scheme in turns, so that what else the machine does hits both
constexpr int kSteps = 2;   // a round; the time is that of one
constexpr glm::vec2 kMean_mps{4, 0};

/// Air without obstacles or forces.
class StillInputs final : public wind::FluidInputs {
public:
    [[nodiscard]] bool active() const override { return true; }
    bool fill_solids(const wind::FluidGrid&, bool) override { return false; }
    void apply_forces(const wind::FluidGrid&) override {}
    [[nodiscard]] double loudest_mps() const override { return 0; }
};

/// Gusts of 2 m/s over a mean wind of 4 m/s, down to six cells, as a window of a larger torus.
void gusty_state(std::vector<float>& u, std::vector<float>& v) {
    constexpr int kSide = 1024;
    std::vector<float> wide_u, wide_v;
    wind::gust_spectrum(kSide, 24, 7).velocities({}, wide_u, wide_v);
    for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * kSide + x;
            u.push_back(kMean_mps.x + 2 * wide_u[at]);
            v.push_back(kMean_mps.y + 2 * wide_v[at]);
        }
    }
}

/// Root mean square of the divergence over that of the speed, per cell, away from the rim.
double divergence_share(const gl::Buffer& u_buffer, const gl::Buffer& v_buffer) {
    const std::size_t count = static_cast<std::size_t>(kCells) * kCells;
    const auto u = u_buffer.read_all<float>(count), v = v_buffer.read_all<float>(count);
    double divergence = 0, square = 0;
    for (int y = kMargin; y < kCells - kMargin; ++y) {
        for (int x = kMargin; x < kCells - kMargin; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * kCells + x;
            const double d = static_cast<double>(u[at + 1]) - static_cast<double>(u[at]) +
                             static_cast<double>(v[at + kCells]) - static_cast<double>(v[at]);
            divergence += d * d;
            square += static_cast<double>(u[at]) * static_cast<double>(u[at]) +
                      static_cast<double>(v[at]) * static_cast<double>(v[at]);
        }
    }
    return std::sqrt(divergence / square);
}

template<class Step> double step_ms(const Step& step) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kSteps; ++i)
        step();
    glFinish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
               .count() /
           kSteps;
}

} // namespace

void bench_wind(BenchReport& report) {
    std::vector<float> u, v;
    gusty_state(u, v);
    wind::FluidSettings settings;
    settings.cells = kCells;
    settings.confinement = 0.3;
    settings.mean_mps = kMean_mps;
    const std::uint64_t before = gl::gpu_bytes();
    wind::Fluid fluid(settings);
    const std::uint64_t between = gl::gpu_bytes();
    wind::PublishedScheme published(settings);
    const std::uint64_t after = gl::gpu_bytes();
    fluid.set_state(u, v);
    published.set_state(u, v);
    StillInputs inputs;
    shared::WindField rim{};
    rim.mean = kMean_mps;
    double time_s = 0;
    const auto own_step = [&] {
        fluid.step(inputs, time_s += settings.step_s, rim, shared::kWindCeiling_mps);
    };
    const auto published_step = [&] { published.step(); };
    for (int i = 0; i < kWarm; ++i) {
        own_step();
        published_step();
    }
    std::vector<double> own_ms, published_ms, ratios;
    for (int round = 0; round < kRounds; ++round) {
        own_ms.push_back(step_ms(own_step));
        published_ms.push_back(step_ms(published_step));
        ratios.push_back(own_ms.back() / published_ms.back());
    }
    const std::string scene = "gusts 1000 x 1000";
    report.rows.push_back({scene, "sward", "step", spread_of(own_ms), between - before});
    report.rows.push_back({scene, "published", "step", spread_of(published_ms), after - between});
    const double own = divergence_share(*fluid.grid().u, *fluid.grid().v),
                 theirs = divergence_share(published.u(), published.v());
    report.checks.push_back(
        {"wind: step over the published scheme's, median of rounds", spread_of(ratios).median, 1});
    report.checks.push_back({"wind: divergence over the published scheme's", own / theirs, 0.05});
    report.checks.push_back({"wind: divergence times cell over speed", own, 1e-3});
}

} // namespace sward::app
