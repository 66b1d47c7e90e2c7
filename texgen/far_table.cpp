// SPDX-License-Identifier: Apache-2.0
#include "texgen/far_table.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/log.h"
#include "texgen/flat_rays.h"
#include "texgen/parallel.h"
#include "texgen/rays.h"

namespace sward::texgen {
namespace {

constexpr std::array kElevationsDeg = {90.0, 82.5, 75.0, 60.0, 45.0, 30.0, 20.0, 10.0, 5.0, 2.0};
// Slices stand further apart than they look tall from above and would show as rows: there the shells cover almost
// as much as the blades do, and the slices only fill up.
constexpr std::array kSliceShares = {0.0, 0.03, 0.1, 0.35, 0.75, 1.0, 1.0, 1.0, 1.0, 1.0};
static_assert(kSliceShares.size() == kElevationsDeg.size());
constexpr int kRays = 32768;            // an elevation: a standard error of 0.3 points at most
constexpr double kCoverageStep = 0.008; // below it, coverage is not worth the shells' fragments

grass::FarRow cast_elevation(const std::vector<BladeField>& fields, double elevation_deg) {
    int hits = 0;
    double height = 0, along = 0;
    for (int i = 0; i < kRays; ++i) {
        const BladeField& field = fields[static_cast<std::size_t>(i) * fields.size() / kRays];
        const SampleRay ray = sample_ray(i, elevation_deg, field.side(), field.canopy());
        if (const std::optional<RayHit> hit = field.cast(ray.origin, ray.direction)) {
            ++hits;
            height += std::clamp(hit->position.y / field.canopy(), 0.0, 1.0);
            along += hit->along;
        }
    }
    grass::FarRow row;
    row.elevation_deg = static_cast<float>(elevation_deg);
    row.coverage = static_cast<float>(hits) / kRays;
    row.height = hits > 0 ? static_cast<float>(height / hits) : 0;
    row.along = hits > 0 ? static_cast<float>(along / hits) : 0;
    return row;
}

/// The least share with which the textures cover what the blades do: at grazing views, where the slices
/// do it alone, shells would only cost fragments, and the most of all. Or the greatest that helps.
float pick_share(const std::vector<float>& needed, double coverage) {
    const auto wanted = static_cast<std::size_t>(std::max(0.0, coverage - kCoverageStep) * static_cast<double>(needed.size()));
    if (wanted == 0)
        return 0;
    const auto helps = static_cast<std::size_t>(std::ranges::upper_bound(needed, static_cast<float>(grass::kMaxShellShare)) - needed.begin());
    return helps == 0 ? 1.0f : needed[std::min(wanted, helps) - 1];
}

double coverage_at(const std::vector<float>& needed, float share) {
    return static_cast<double>(std::ranges::upper_bound(needed, share) - needed.begin()) / static_cast<double>(needed.size());
}

} // namespace

std::vector<grass::FarRow> far_table(const Patch& patch, double canopy_m, int threads) {
    std::vector<BladeField> fields;
    for (int v = 0; v < patch.variants(); ++v)
        fields.emplace_back(patch.variant(v), patch.looks, patch.side_m, canopy_m);
    std::vector<grass::FarRow> rows = empty_far_rows();
    parallel_for(rows.size(), resolve_threads(threads), [&](std::size_t i, int) {
        const float slice_share = rows[i].slice_share;
        rows[i] = cast_elevation(fields, kElevationsDeg[i]);
        rows[i].slice_share = slice_share;
    });
    return rows;
}

std::vector<grass::FarRow> empty_far_rows() {
    std::vector<grass::FarRow> rows(kElevationsDeg.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].elevation_deg = static_cast<float>(kElevationsDeg[i]);
        rows[i].slice_share = static_cast<float>(kSliceShares[i]);
    }
    return rows;
}

void calibrate_shells(grass::GrassSet& set, int threads) {
    const std::size_t levels = set.levels.size();
    std::vector<std::vector<float>> curves(set.far.size() * levels); // row-major
    parallel_for(curves.size(), resolve_threads(threads), [&](std::size_t i, int) {
        curves[i] = shares_needed(set, static_cast<int>(i % levels),
                                set.far[i / levels], kRays);
    });
    base::log_debug("elevation  level   rays  all shells  share  calibrated");
    std::vector<float> shares(levels, 1);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        grass::FarRow& row = set.far[i / levels];
        float& share = shares[i % levels];
        share = pick_share(curves[i], row.coverage);
        base::log_debug(fmt::format("{:9.0f}  {:5}  {:.3f}  {:10.3f}  {:.3f}  {:10.3f}",
                                    row.elevation_deg, i % levels, row.coverage,
                                    coverage_at(curves[i], 1), share, coverage_at(curves[i], share)));
        if (i % levels + 1 == levels) {
            row.shell_share = shares[0];
            row.coarse_shares.assign(shares.begin() + 1, shares.end());
        }
    }
}

} // namespace sward::texgen
