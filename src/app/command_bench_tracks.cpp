// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <functional>

#include <epoxy/gl.h>

#include "app/bench.h"
#include "tracks/tracks.h"

namespace sward::app {
namespace {

constexpr int kSide = 15; // 225 pages, as published
constexpr int kMostBlocks = kSide * kSide * tracks::Tracks::kMovingBlocksAPage;
constexpr int kWarm = 2, kRounds = 5;
constexpr double kCanopy_m = 0.3;
constexpr int kTable = 1024; // of the pages, as Pages has for so many

double timed_ms(const std::function<void()>& work) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    work();
    glFinish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

/// 225 pages, each crossed by a wheel from west to east: what moves is the blocks within 1.5 m of
/// where it has been.
tracks::TrackPass::Work crossed(double cell_m) {
    constexpr int kRow = shared::kTrackRow, kFirst = 3, kRows = 2; // rows of blocks that move
    tracks::TrackPass::Work work;
    const auto place = [](int page_x, int page_z, int x, int z) {
        page_x += x < 0 ? -1 : x >= kRow ? 1 : 0;
        x = (x + kRow) % kRow;
        return page_x < 0 || page_x >= kSide || z < kFirst || z >= kFirst + kRows
                   ? -1
                   : ((page_z * kSide + page_x) * kRows + z - kFirst) * kRow + x;
    };
    const auto middle = static_cast<float>(0.5 * cell_m * shared::kTrackCells);
    for (int page = 0; page < kSide * kSide; ++page) {
        const int page_x = page % kSide, page_z = page / kSide;
        for (int z = kFirst; z < kFirst + kRows; ++z) {
            for (int x = 0; x < kRow; ++x) {
                shared::TrackBlock block{};
                block.slot = block.first_print = page;
                block.prints = x == kRow / 2 || x == kRow / 2 - 1 ? 1 : 0;
                block.first_cell = glm::ivec2(x, z) * shared::kTrackBlock;
                block.own = place(page_x, page_z, x, z);
                block.beside = {place(page_x, page_z, x - 1, z), place(page_x, page_z, x + 1, z),
                                place(page_x, page_z, x, z - 1), place(page_x, page_z, x, z + 1)};
                work.moving.push_back(block);
            }
        }
        shared::TrackPrint print{};
        print.now = {{middle, middle}, {0, 1}};
        print.before = {{middle - 0.2f, middle}, {0, 1}};
        print.half_width_m = 0.15f;
        print.half_depth_m = 0.35f;
        print.load = 1;
        print.kind = shared::kPrintWheel;
        work.prints.push_back(print);
    }
    return work;
}

/// Every block that the pool has room for.
tracks::TrackPass::Work full() {
    tracks::TrackPass::Work work;
    for (int place = 0; place < kMostBlocks; ++place) {
        shared::TrackBlock block{};
        const int n = place % shared::kTrackBlocks;
        block.slot = place / shared::kTrackBlocks;
        block.first_cell =
            glm::ivec2(n % shared::kTrackRow, n / shared::kTrackRow) * shared::kTrackBlock;
        block.own = place;
        block.beside = {-1, -1, -1, -1};
        work.moving.push_back(block);
    }
    return work;
}

} // namespace

void bench_tracks(BenchReport& report) {
    const scene::TrackSpec spec;
    const shared::TrackRules rules = tracks::rules_of(spec, kCanopy_m);
    const tracks::TrackPass::Work work = crossed(spec.cell_m), most = full();
    tracks::TrackPass pass(kSide * kSide, kMostBlocks, kTable);
    pass.reserve(kSide * kSide, kMostBlocks);
    tracks::Pages pages(kSide * kSide, spec.cell_m * shared::kTrackCells);
    pass.set_table(pages.table());
    std::vector<int> slots;
    for (int n = 0; n < kSide * kSide; ++n) {
        slots.push_back(n);
    }
    std::vector<double> step, all, show;
    for (int round = -kWarm; round < kRounds; ++round) {
        const double a = timed_ms([&] { pass.step(rules, work); });
        const double b = timed_ms([&] { pass.step(rules, most); });
        const double c = timed_ms([&] { pass.show(slots); });
        if (round >= 0) {
            step.push_back(a);
            all.push_back(b);
            show.push_back(c);
        }
    }
    const std::string scene = "225 pages of 128 x 128";
    report.rows.push_back({scene, "a wheel in each", "step", spread_of(step), pass.bytes()});
    report.rows.push_back(
        {scene, "every block that can move", "step", spread_of(all), pass.bytes()});
    report.rows.push_back({scene, "all changed", "show", spread_of(show), pass.bytes()});
    const double asleep = timed_ms([&] { pass.step(rules, {}); });
    report.rows.push_back({scene, "all asleep", "step", {asleep, asleep, asleep}, pass.bytes()});
    report.figures.push_back(
        {scene, "sward", "megabytes of the pool", static_cast<double>(pass.bytes()) / 1e6, 63});
    report.figures.push_back({scene, "sward", "cells",
                              kSide * kSide * double{shared::kTrackCells} * shared::kTrackCells,
                              225.0 * 128 * 128});
    report.checks.push_back({"tracks: a step with all pages asleep over one with a wheel in each",
                             asleep / spread_of(step).median, 0.01});
}

} // namespace sward::app
