// SPDX-License-Identifier: Apache-2.0
// The far tier as rays see it: shells and slices together against the blades.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "grass_fixture.h"
#include "texgen/far/flat_rays.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

constexpr int kRays = 8192;

const grass::FarRow& row_at(const grass::GrassSet& set, float elevation_deg) {
    for (const grass::FarRow& row : set.far)
        if (row.elevation_deg == elevation_deg)
            return row;
    throw std::out_of_range("no such row");
}

TEST(FarTier, CalibratedItCoversWhatTheBladesCover) {
    const grass::GrassSet& set = small_set();
    for (const float elevation : {90.0f, 60.0f, 45.0f, 30.0f, 10.0f}) {
        const grass::FarRow& row = row_at(set, elevation);
        const grass::FarRow flat =
            flat_coverage(set, 0, elevation, {row.shell_share, row.slice_share}, kRays);
        EXPECT_NEAR(flat.coverage, row.coverage, 0.03) << elevation;
    }
}

TEST(FarTier, CalibrationLeavesTheMeadowsHeightAndCoarserLevels) {
    base::set_verbosity(base::Verbosity::kQuiet);
    Preset preset = load_preset(fs::path(SWARD_SOURCE_DIR) / "texgen/presets/meadow.toml");
    preset.variants = 1;
    preset.levels = 3;
    preset.size = 256;
    preset.far_rays = 8192;
    const grass::GrassSet set = bake_set(preset, {.threads = 2, .volume = false, .preview = false});
    for (const grass::FarRow& row : set.far)
        for (int level = 0; level < 3; ++level) {
            const FlatUse use{row.share_at(level), row.slice_share};
            const grass::FarRow flat = flat_coverage(set, level, row.elevation_deg, use, kRays);
            EXPECT_NEAR(flat.coverage, row.coverage, 0.03) << row.elevation_deg << " " << level;
            if (level == 0) {
                EXPECT_NEAR(flat.height, row.height, 0.05) << row.elevation_deg;
            }
        }
    EXPECT_LT(row_at(set, 30).shell_share, 0.8f); // there is something to correct
}

TEST(FarTier, SharesNeededAreWhatRaysMeetAtEachShare) {
    const grass::GrassSet& set = small_set();
    for (const double elevation : {75.0, 30.0}) {
        grass::FarRow row;
        row.elevation_deg = static_cast<float>(elevation);
        const std::vector<float> needed = shares_needed(set, 1, row, 4000);
        double before = -1;
        for (const float share : {0.0f, 0.3f, 1.0f, 3.0f}) {
            const auto met =
                static_cast<double>(std::ranges::upper_bound(needed, share) - needed.begin());
            EXPECT_NEAR(met / 4000, flat_coverage(set, 1, elevation, {share, 1}, 4000).coverage,
                        1e-6)
                << share;
            EXPECT_GT(met, before) << share; // each share adds some
            before = met;
        }
    }
}

} // namespace
} // namespace sward::texgen
