// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/far_table.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/log.h"
#include "texgen/far/flat_rays.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

constexpr std::array kElevationsDeg = {90.0, 82.5, 75.0, 60.0, 45.0, 30.0, 20.0, 10.0, 5.0, 2.0};
// Slices stand further apart than they look tall from above and would show as rows: there the
// shells cover almost as much as the blades do, and the slices only fill up.
constexpr std::array kSliceShares = {0.0, 0.03, 0.1, 0.35, 0.75, 1.0, 1.0, 1.0, 1.0, 1.0};
static_assert(kSliceShares.size() == kElevationsDeg.size());
constexpr int kBatch = 1024; // rays of one task
// Of the rays at rest, in hits and at most in rays. The light of a hit varies by 0.7 of its mean
// (meadow): 2048 hits leave an error of 1.5 % a view, less between views.
constexpr double kLeaningHits = 1.0 / 16, kLeaningRays = 1.0 / 2;
constexpr double kCoverageStep = 0.008; // below it, coverage is not worth the shells' fragments

grass::FarRow row_of(const ViewSums& sums, std::size_t elevation) {
    const auto hits = static_cast<double>(sums.hits);
    grass::FarRow row;
    row.elevation_deg = static_cast<float>(kElevationsDeg[elevation]);
    row.coverage = static_cast<float>(sums.hits) / static_cast<float>(sums.rays);
    row.height = sums.hits > 0 ? static_cast<float>(sums.height / hits) : 0;
    row.along = sums.hits > 0 ? static_cast<float>(sums.along / hits) : 0;
    row.slice_share = static_cast<float>(kSliceShares[elevation]);
    return row;
}

/// Casts all views of one bend, in batches that workers share; the sums are added in order.
std::vector<ViewSums> cast_views(const Canopy& canopy, double lean, std::vector<ViewRays> views,
                                 int threads) {
    struct Batch {
        std::size_t view;
        ViewRays rays;
        ViewSums sums;
    };
    std::vector<Batch> batches;
    for (std::size_t v = 0; v < views.size(); ++v)
        for (int first = 0; first < views[v].count; first += kBatch) {
            views[v].first = first;
            views[v].end = std::min(first + kBatch, views[v].count);
            batches.push_back({v, views[v], {}});
        }
    const std::vector<Caster> casters = canopy.bent(lean);
    base::Progress progress(lean > 0 ? fmt::format("far table, bent by {:.1f}", lean)
                                     : "far table, at rest",
                            batches.size());
    parallel_for(batches.size(), resolve_threads(threads), [&](std::size_t i, int) {
        batches[i].sums = cast_view(canopy, casters, batches[i].rays);
        progress.advance();
    });
    std::vector<ViewSums> sums(views.size());
    for (const Batch& batch : batches)
        sums[batch.view].add(batch.sums);
    return sums;
}

/// Views of a leaning canopy: as many rays as it takes to meet enough of it.
std::vector<ViewRays> leaning_views(const FarTable& table, double lean, int rays) {
    std::vector<ViewRays> views;
    for (const float azimuth : table.light.lean_azimuths_deg)
        for (const grass::FarRow& row : table.rows) {
            const double needed = kLeaningHits * rays / std::max<double>(row.coverage, 1e-3);
            const int count = 2 * static_cast<int>(std::min(needed, kLeaningRays * rays) / 2);
            views.push_back({row.elevation_deg, azimuth, 0, 0, count, 1, lean});
        }
    return views;
}

/// The least share with which the textures cover what the blades do: at grazing views, where the
/// slices do it alone, shells would only cost fragments, and the most of all. Or the greatest that
/// helps.
float pick_share(const std::vector<float>& needed, double coverage) {
    const auto wanted = static_cast<std::size_t>(std::max(0.0, coverage - kCoverageStep) *
                                                 static_cast<double>(needed.size()));
    if (wanted == 0)
        return 0;
    const auto helps = static_cast<std::size_t>(
        std::ranges::upper_bound(needed, static_cast<float>(grass::kMaxShellShare)) -
        needed.begin());
    return helps == 0 ? 1.0f : needed[std::min(wanted, helps) - 1];
}

double coverage_at(const std::vector<float>& needed, float share) {
    return static_cast<double>(std::ranges::upper_bound(needed, share) - needed.begin()) /
           static_cast<double>(needed.size());
}

} // namespace

FarTable far_table(const Canopy& canopy, int rays, int threads) {
    FarTable table;
    std::vector<ViewRays> at_rest;
    for (const double elevation : kElevationsDeg)
        at_rest.push_back({elevation, std::nullopt, 0, 0, rays, elevation < 40 ? 4 : 1,
                           0}); // low views hit often
    const std::vector<ViewSums> rest = cast_views(canopy, 0, at_rest, threads);
    for (std::size_t i = 0; i < rest.size(); ++i)
        table.rows.push_back(row_of(rest[i], i));

    grass::FarLight& light = table.light;
    light = light_axes({kElevationsDeg.begin(), kElevationsDeg.end()});
    const std::size_t azimuths = light.lean_azimuths_deg.size();
    for (std::size_t lean = 0; lean < light.leans.size(); ++lean) {
        const std::vector<ViewSums> sums =
            lean == 0 ? rest
                      : cast_views(canopy, light.leans[lean],
                                   leaning_views(table, light.leans[lean], rays), threads);
        for (std::size_t a = 0; a < azimuths; ++a)
            for (std::size_t e = 0; e < rest.size(); ++e) // at rest every azimuth sees the same
                store_view(sums[lean == 0 ? e : a * rest.size() + e],
                           lean == 0 || a == 0 || a + 1 == azimuths, light.image(lean, a, e),
                           light);
    }
    return table;
}

void calibrate_shells(grass::GrassSet& set, int rays, int threads) {
    const std::size_t levels = set.levels.size();
    std::vector<std::vector<float>> curves(set.far.size() * levels); // row-major
    base::Progress progress("shares of the shells", curves.size());
    parallel_for(curves.size(), resolve_threads(threads), [&](std::size_t i, int) {
        curves[i] = shares_needed(set, static_cast<int>(i % levels), set.far[i / levels], rays);
        progress.advance();
    });
    base::log_debug("elevation  level   rays  all shells  share  calibrated");
    std::vector<float> shares(levels, 1);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        grass::FarRow& row = set.far[i / levels];
        float& share = shares[i % levels];
        share = pick_share(curves[i], row.coverage);
        base::log_debug(fmt::format(
            "{:9.0f}  {:5}  {:.3f}  {:10.3f}  {:.3f}  {:10.3f}", row.elevation_deg, i % levels,
            row.coverage, coverage_at(curves[i], 1), share, coverage_at(curves[i], share)));
        if (i % levels + 1 == levels) {
            row.shell_share = shares[0];
            row.coarse_shares.assign(shares.begin() + 1, shares.end());
        }
    }
}

} // namespace sward::texgen
