// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <functional>

#include <epoxy/gl.h>

#include "app/bench.h"
#include "tracks/tracks.h"

namespace sward::app {
namespace {

constexpr int kSide = 15;     // 225 pages, as published
constexpr int kWarm = 2, kRounds = 5;
constexpr double kCanopy_m = 0.3;

double timed_ms(const std::function<void()>& work) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    work();
    glFinish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// 225 pages that all move, each crossed by a wheel.
struct Pool {
    std::vector<shared::TrackPage> pages;
    std::vector<shared::TrackPrint> prints;
};

Pool crossed(double cell_m) {
    Pool pool;
    const auto slot = [](int x, int z) { return x < 0 || z < 0 || x >= kSide || z >= kSide ? -1 : z * kSide + x; };
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            shared::TrackPage page{};
            page.slot = {slot(x, z), static_cast<int>(pool.prints.size()), 1, 0};
            page.beside = {slot(x - 1, z), slot(x + 1, z), slot(x, z - 1), slot(x, z + 1)};
            pool.pages.push_back(page);
            shared::TrackPrint print{};
            const auto middle = static_cast<float>(0.5 * cell_m * shared::kTrackCells);
            print.now = {middle, middle, 0, 1};
            print.before = {middle - 0.2f, middle, 0, 1};
            print.shape = {0.15f, 0.35f, 0, 1};
            print.kind.x = shared::kPrintWheel;
            pool.prints.push_back(print);
        }
    }
    return pool;
}

} // namespace

void bench_tracks(BenchReport& report) {
    const scene::TrackSpec spec;
    const shared::TrackRules rules = tracks::rules_of(spec, kCanopy_m);
    const Pool pool = crossed(spec.cell_m);
    tracks::TrackPass pass(1024);
    pass.reserve(kSide * kSide);
    std::vector<int> slots;
    for (int n = 0; n < kSide * kSide; ++n) {
        slots.push_back(n);
    }
    std::vector<double> step, show;
    for (int round = -kWarm; round < kRounds; ++round) {
        const double a = timed_ms([&] { pass.step(rules, pool.pages, pool.prints, false); });
        const double c = timed_ms([&] { pass.show(slots); });
        if (round >= 0) {
            step.push_back(a);
            show.push_back(c);
        }
    }
    const std::string scene = "225 pages of 128 x 128";
    report.rows.push_back({scene, "all move", "step", spread_of(step), pass.bytes()});
    report.rows.push_back({scene, "all changed", "show", spread_of(show), pass.bytes()});
    const double asleep = timed_ms([&] { pass.step(rules, {}, {}, false); });
    report.rows.push_back({scene, "all asleep", "step", {asleep, asleep, asleep}, pass.bytes()});
    report.figures.push_back({scene, "sward", "megabytes of the pool", static_cast<double>(pass.bytes()) / 1e6, 63});
    report.figures.push_back({scene, "sward", "cells", kSide * kSide * double{shared::kTrackCells} * shared::kTrackCells, 225.0 * 128 * 128});
    report.checks.push_back({"tracks: a step with all pages asleep over one with all awake", asleep / spread_of(step).median, 0.01});
}

} // namespace sward::app
