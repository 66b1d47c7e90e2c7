// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/march_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/log.h"
#include "texgen/far/march_rays.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

using shared::kMarchColumns;

constexpr std::array kElevationsDeg = {3.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0};
constexpr std::array kMips = {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0};
constexpr double kLeast = 0.03, kMost = 6; // of the factor; a solid volume counts its inside too
constexpr double kDarkest = 0.5;           // factor on the light
constexpr int kTries = 10;                 // of a fit, at most; three do as a rule
constexpr double kCloseEnough = 5e-4;      // of found_at's mean
constexpr int kTruthRays = 12000;          // of a view, at most
constexpr int kMarched =
    20; // of so many true rays one is marched: its noise is an average's already

double true_mean(const MarchData& data, const HeightCaster& truth, const MarchCase& which,
                 int rays) {
    const double canopy = data.medium.canopy_m;
    double sum = 0;
    for (int i = 0; i < rays; ++i) {
        const SampleRay ray =
            sample_ray(i, std::min(which.elevation_deg, 89.9), data.medium.side_m, canopy);
        const std::optional<double> height =
            truth(ray, static_cast<std::uint64_t>(i), which.density);
        sum += height ? found_at(*height, canopy) : 0;
    }
    return sum / rays;
}

/// The factor at which as much is found as wanted: secants on its logarithm within a bracket, from
/// `guess` on. What is found grows with it.
double fit_one(const MarchMean& march, double wanted, double guess) {
    constexpr double kFirstStep = 0.3;
    double low = std::log(kLeast), high = std::log(kMost);
    double x = std::log(guess), before = x, missed_before = 0;
    for (int i = 0; i < kTries; ++i) {
        const double missed = march.at(std::exp(x)).found - wanted;
        (missed < 0 ? low : high) = x;
        if (std::abs(missed) < kCloseEnough || high - low < 0.01)
            break;
        const double rise = i > 0 ? (missed - missed_before) / (x - before) : 0;
        double next = rise > 1e-6 ? x - missed / rise : x + (missed < 0 ? kFirstStep : -kFirstStep);
        if (next <= low || next >= high || i > kTries / 2)
            next = 0.5 * (low + high);
        before = x;
        missed_before = missed;
        x = next;
    }
    return std::exp(x);
}

/// A value at x among rising nodes, linear between them and held at both ends.
template<std::size_t N>
double between(const std::array<double, N>& nodes, const std::array<double, N>& values, double x) {
    if (x <= nodes.front())
        return values.front();
    for (std::size_t i = 1; i < N; ++i)
        if (x <= nodes[i])
            return std::lerp(values[i - 1], values[i],
                             (x - nodes[i - 1]) / (nodes[i] - nodes[i - 1]));
    return values.back();
}

void report_factors(const std::vector<std::array<double, kMips.size()>>& found) {
    constexpr std::size_t kKinds = shared::kMarchSets + 1, kElevations = kElevationsDeg.size();
    for (const std::size_t table : {std::size_t{0}, grass::kMarchDensities.size()})
        for (std::size_t kind = 0; kind < kKinds; ++kind)
            for (std::size_t e = 0; e < kElevations; ++e) {
                std::string text =
                    fmt::format("march: {}, kind {}, {:2.0f} deg:", table == 0 ? "depth" : "light",
                                kind, kElevationsDeg[e]);
                for (const double factor : found[(table * kElevations + e) * kKinds + kind])
                    text += fmt::format(" {:.2f}", factor);
                base::log_debug(text);
            }
}

} // namespace

std::vector<float> fit_march(const MarchData& data, const HeightCaster& truth, int rays,
                             int threads) {
    const int true_rays = std::min(rays, kTruthRays), marched = std::max(true_rays / kMarched, 10);
    constexpr std::size_t kKinds = shared::kMarchSets + 1, kElevations = kElevationsDeg.size();
    constexpr std::size_t kDensities = grass::kMarchDensities.size();
    // [depth, light][density][elevation][kind][mip]
    constexpr std::size_t kTable = kDensities * kElevations * kKinds;
    std::vector<std::array<double, kMips.size()>> found(2 * kTable);
    const MarchTextureSet textures(data);
    base::Progress progress("the march's correction", kDensities * kElevations);
    parallel_for(kDensities * kElevations, resolve_threads(threads), [&](std::size_t i, int) {
        const double density = grass::kMarchDensities[i / kElevations],
                     elevation = kElevationsDeg[i % kElevations];
        const double wanted = true_mean(data, truth, {0, 0, elevation, density}, true_rays);
        std::array<std::array<double, kMips.size()>, kKinds> light{}; // mean of what is seen
        for (std::size_t kind = 0; kind < kKinds; ++kind)
            for (std::size_t m = 0; m < kMips.size(); ++m) {
                auto& row = found[i * kKinds + kind];
                const bool rare = kind != kMarchColumns &&
                                  (elevation > 75 || kMips[m] > 6); // columns show such views
                const MarchMean march(
                    textures, {static_cast<int>(kind), kMips[m], elevation, density}, marched);
                row[m] =
                    rare && m > 0 ? row[m - 1] : fit_one(march, wanted, m > 0 ? row[m - 1] : 1);
                const Marched seen = march.at(row[m], true);
                light[kind][m] = seen.light / std::max(seen.seen, 1e-9);
            }
        for (std::size_t kind = 0; kind < kKinds;
             ++kind) // as bright as the columns' coarsest mip, which the set's far light corrects
            for (std::size_t m = 0; m < kMips.size(); ++m)
                found[kTable + i * kKinds + kind][m] =
                    std::clamp(light[kMarchColumns].back() / std::max(light[kind][m], 1e-9),
                               kDarkest, 1 / kDarkest);
        progress.advance();
    });
    std::vector<float> table;
    const auto value = [&](std::size_t which, std::size_t kind, int half, int step) {
        std::array<double, kElevations> at{};
        for (std::size_t e = 0; e < kElevations; ++e)
            at[e] = between(kMips, found[(which * kElevations + e) * kKinds + kind], 0.5 * half);
        return static_cast<float>(between(kElevationsDeg, at, 5.0 * step));
    };
    for (std::size_t kind = 0; kind < kKinds; ++kind)
        for (int half = 0; half < shared::kMarchMips; ++half)
            for (int step = 0; step < shared::kMarchElevations; ++step)
                for (std::size_t density = 0; density < kDensities; ++density) {
                    table.push_back(value(density, kind, half, step));
                    table.push_back(value(kDensities + density, kind, half, step));
                }
    report_factors(found);
    return table;
}

std::vector<double> heights_met(const HeightCaster& truth, double side_m, double canopy_m) {
    std::vector<double> heights;
    for (const double elevation : {2.0, 5.0, 12.0, 30.0, 50.0, 80.0}) {
        const std::size_t first = heights.size();
        for (int i = 0; i < kTruthRays / 2; ++i)
            if (const std::optional<double> height = truth(
                    sample_ray(i, elevation, side_m, canopy_m), static_cast<std::uint64_t>(i), 1))
                heights.push_back(*height);
        const std::size_t met = heights.size() - first;
        for (std::size_t n = met; n > 0 && n < kTruthRays / 2;
             ++n) // a sparse canopy's steep views count as much
            heights.push_back(heights[first + n % met]);
    }
    std::ranges::sort(heights);
    return heights;
}

HeightCaster cast_blades(const Patch& patch, double canopy_m) {
    auto fields =
        std::make_shared<std::vector<std::vector<BladeField>>>(grass::kMarchDensities.size());
    for (std::size_t d = 0; d < grass::kMarchDensities.size(); ++d)
        for (int v = 0; v < patch.variants(); ++v) {
            std::vector<shared::BladeRecord> standing;
            for (const shared::BladeRecord& blade : patch.variant(v))
                if (blade.root.w < grass::kMarchDensities[d])
                    standing.push_back(blade);
            (*fields)[d].emplace_back(standing, patch.looks, patch.side_m, canopy_m);
        }
    return [fields](const SampleRay& ray, std::uint64_t number,
                    double density) -> std::optional<double> {
        const std::size_t d = density < 0.999 ? 1 : 0;
        const std::vector<BladeField>& variants = (*fields)[d];
        const std::optional<RayHit> hit =
            variants[number % variants.size()].cast(ray.origin, ray.direction);
        return hit ? std::optional<double>(hit->position.y) : std::nullopt;
    };
}

} // namespace sward::texgen
