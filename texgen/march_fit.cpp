// SPDX-License-Identifier: Apache-2.0
#include "texgen/march_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "shared/march.h"
#include "shared/shading.h"
#include "texgen/parallel.h"

namespace sward::texgen {
namespace {

using shared::kMarchColumns;

constexpr std::array kElevationsDeg = {3.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0};
constexpr std::array kMips = {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0};
constexpr double kLeast = 0.03, kMost = 6; // of the factor; a solid volume counts its inside too
constexpr int kHalvings = 7;
constexpr int kTruthRays = 6000; // of a view, at most
constexpr int kMarched = 20;        // of so many true rays one is marched: its noise is an average's already
constexpr std::uint64_t kStream = 0x3a2c;

/// What a ray that ends at this height brings: brighter up in the canopy, as shade_grass has it with the sun and the sky in halves; the
/// ground is dark. Any rising function would do whose mean tells both how much is seen of the grass and how deep.
double light_at(double height, double canopy) {
    const double under = 1 - height / canopy;
    return 0.5 * std::exp(-shared::kSunExtinction * under / 0.57) + 0.5 * std::exp(-shared::kSkyExtinction * under);
}
constexpr double kGroundLight = 0.08;

/// Trilinear, repeating along u and, if asked, along v: as the GPU reads it.
class Reader {
public:
    Reader(const MarchImages& images, bool repeat_v) : images_(images), repeat_v_(repeat_v) {}
    [[nodiscard]] float density(glm::vec3 place, float mip) const {
        const float last = static_cast<float>(images_.mips.size() - 1), m = std::clamp(mip, 0.0f, last);
        const auto low = static_cast<int>(m);
        const float share = m - static_cast<float>(low);
        const float near = at(place, low);
        return share > 0 ? std::lerp(near, at(place, low + 1), share) : near;
    }

private:
    [[nodiscard]] float at(glm::vec3 place, int mip) const {
        const int w = std::max(1, images_.width >> mip), h = std::max(1, images_.height >> mip);
        const float u = (place.x - std::floor(place.x)) * static_cast<float>(w) - 0.5f;
        const float v = (repeat_v_ ? place.y - std::floor(place.y) : place.y) * static_cast<float>(h) - 0.5f;
        const auto column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
        const float a = u - static_cast<float>(column), b = v - static_cast<float>(row);
        const auto texel = [&](int x, int y) {
            x = (x + w) % w;
            y = repeat_v_ ? (y + h) % h : std::clamp(y, 0, h - 1);
            return images_.mips[static_cast<std::size_t>(mip)][((static_cast<std::size_t>(place.z) * h + y) * w + x) * MarchImages::kFloats + MarchImages::kDensity];
        };
        return std::lerp(std::lerp(texel(column, row), texel(column + 1, row), a), std::lerp(texel(column, row + 1), texel(column + 1, row + 1), a), b);
    }
    const MarchImages& images_;
    bool repeat_v_;
};

struct Case {
    int kind = 0;
    double mip = 0, elevation_deg = 0, density = 1;
};

/// Mean light that the march sees with a factor.
class MarchMean {
public:
    MarchMean(const MarchData& data, const Case& which, int rays) : data_(data), case_(which), rays_(rays) {
        const double texel = data.medium.size.x / static_cast<double>(shared::kMarchTexels);
        const double softness = shared::kSlabSoftness;
        footprint_ = which.kind == kMarchColumns
                         ? texel * std::exp2(which.mip - shared::kColumnBias)
                         : texel * std::sqrt(std::max(std::exp2(2 * which.mip) - softness * softness, 0.02)) * std::exp2(-static_cast<double>(shared::kSlabBias));
    }
    [[nodiscard]] double at(double factor) const {
        double sum = 0;
        for (int i = 0; i < rays_; ++i)
            sum += one(i, static_cast<float>(factor));
        return sum / rays_;
    }

private:
    [[nodiscard]] double one(int number, float factor) const {
        const shared::MarchMedium& medium = data_.medium;
        const auto random = [&](std::uint64_t n) { return base::hash_unit(kStream, n, static_cast<std::uint64_t>(number)); };
        const double elevation = std::min(case_.elevation_deg, 89.9) * std::numbers::pi / 180, azimuth = random(2) * 2 * std::numbers::pi;
        const glm::vec3 way(std::cos(elevation) * std::cos(azimuth), -std::sin(elevation), std::cos(elevation) * std::sin(azimuth));
        shared::MarchPath path;
        path.from = {static_cast<float>(random(0)) * medium.size.x, medium.size.y, static_cast<float>(random(1)) * medium.size.x};
        path.way = way;
        path.height = {medium.size.y, way.y, 0, -medium.size.y / way.y};
        path.bend = {1, 0, 0, medium.size.y};
        constexpr float kFar = 1000;
        shared::MarchPlan plan = shared::march_look(medium, path, {static_cast<float>(footprint_) / kFar, kFar, static_cast<float>(case_.density)});
        plan.footprint = static_cast<float>(footprint_);
        plan.kind = case_.kind;
        plan.axis = std::abs(plan.level.x) > std::abs(plan.level.y) ? 0 : 1;
        shared::march_settle(medium, plan);
        const float variant = std::floor(static_cast<float>(random(4)) * medium.size.w);
        return walk(path, plan, factor, variant);
    }

    [[nodiscard]] double walk(const shared::MarchPath& path, const shared::MarchPlan& plan, float factor, float variant) const {
        const shared::MarchMedium& medium = data_.medium;
        const Reader reader(plan.kind == kMarchColumns ? data_.columns : data_.slabs[plan.kind], plan.kind == kMarchColumns);
        const float scale = factor * plan.density;
        shared::MarchWalk at = shared::march_begin(path);
        double through = 1, light = 0;
        for (int n = 0; n < shared::kMarchSteps && shared::march_inside(path, at); ++n) {
            const shared::MarchStep step = shared::march_step(medium, path, plan, at, {static_cast<float>(n), scale});
            const glm::vec3 texel = shared::march_texel(medium, plan, step, {step.rest.x / medium.size.x, step.rest.z / medium.size.x, variant});
            const double passed = std::exp(-scale * step.depth * reader.density(texel, step.mip - shared::march_base(plan.kind)));
            light += through * (1 - passed) * light_at(step.rest.y, medium.size.y);
            through *= passed;
            if (through < shared::kMarchEnd) {
                return light / (1 - through);
            }
        }
        return light + through * kGroundLight;
    }

    const MarchData& data_;
    Case case_;
    int rays_;
    double footprint_;
};

double true_mean(const MarchData& data, const HeightCaster& truth, const Case& which, int rays) {
    const double canopy = data.medium.size.y;
    double sum = 0;
    for (int i = 0; i < rays; ++i) {
        const SampleRay ray = sample_ray(i, std::min(which.elevation_deg, 89.9), data.medium.size.x, canopy);
        const std::optional<double> height = truth(ray, static_cast<std::uint64_t>(i), which.density);
        sum += height ? light_at(*height, canopy) : kGroundLight;
    }
    return sum / rays;
}

double fit_one(const MarchMean& march, double wanted) {
    double low = kLeast, high = kMost;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = std::sqrt(low * high);
        (march.at(middle) < wanted ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

/// A value at x among rising nodes, linear between them and held at both ends.
template<std::size_t N> double between(const std::array<double, N>& nodes, const std::array<double, N>& values, double x) {
    if (x <= nodes.front())
        return values.front();
    for (std::size_t i = 1; i < N; ++i)
        if (x <= nodes[i])
            return std::lerp(values[i - 1], values[i], (x - nodes[i - 1]) / (nodes[i] - nodes[i - 1]));
    return values.back();
}

} // namespace

std::vector<float> fit_march(const MarchData& data, const HeightCaster& truth, int rays, int threads) {
    const int true_rays = std::min(rays, kTruthRays), marched = std::max(true_rays / kMarched, 40);
    constexpr std::size_t kKinds = shared::kMarchSets + 1, kElevations = kElevationsDeg.size();
    constexpr std::size_t kDensities = grass::kMarchDensities.size();
    // [density][elevation][kind][mip]
    std::vector<std::array<double, kMips.size()>> found(kDensities * kElevations * kKinds);
    parallel_for(kDensities * kElevations, resolve_threads(threads), [&](std::size_t i, int) {
        const double density = grass::kMarchDensities[i / kElevations], elevation = kElevationsDeg[i % kElevations];
        const double wanted = true_mean(data, truth, {0, 0, elevation, density}, true_rays);
        for (std::size_t kind = 0; kind < kKinds; ++kind)
            for (std::size_t m = 0; m < kMips.size(); ++m) {
                auto& row = found[i * kKinds + kind];
                const bool rare = kind != kMarchColumns && (elevation > 75 || kMips[m] > 6); // columns show such views
                row[m] = rare && m > 0 ? row[m - 1] : fit_one(MarchMean(data, {static_cast<int>(kind), kMips[m], elevation, density}, marched), wanted);
            }
    });
    std::vector<float> table;
    for (std::size_t d = 0; d < kDensities; ++d)
        for (int half = 0; half < shared::kMarchMips; ++half)
            for (int step = 0; step < shared::kMarchElevations; ++step)
                for (std::size_t kind = 0; kind < kKinds; ++kind) {
                    std::array<double, kElevations> at{};
                    for (std::size_t e = 0; e < kElevations; ++e)
                        at[e] = between(kMips, found[(d * kElevations + e) * kKinds + kind], 0.5 * half);
                    table.push_back(static_cast<float>(between(kElevationsDeg, at, 5.0 * step)));
                }
    for (std::size_t kind = 0; kind < kKinds; ++kind)
        for (std::size_t e = 0; e < kElevations; ++e) {
            std::string text = fmt::format("march: kind {}, {:2.0f} deg:", kind, kElevationsDeg[e]);
            for (const double factor : found[e * kKinds + kind])
                text += fmt::format(" {:.2f}", factor);
            base::log_debug(text);
        }
    return table;
}

std::vector<double> heights_met(const HeightCaster& truth, double side_m, double canopy_m) {
    std::vector<double> heights;
    for (const double elevation : {2.0, 5.0, 12.0, 30.0, 50.0, 80.0}) {
        const std::size_t first = heights.size();
        for (int i = 0; i < kTruthRays / 2; ++i)
            if (const std::optional<double> height = truth(sample_ray(i, elevation, side_m, canopy_m), static_cast<std::uint64_t>(i), 1))
                heights.push_back(*height);
        const std::size_t met = heights.size() - first;
        for (std::size_t n = met; n > 0 && n < kTruthRays / 2; ++n) // a sparse canopy's steep views count as much
            heights.push_back(heights[first + n % met]);
    }
    std::ranges::sort(heights);
    return heights;
}

HeightCaster cast_blades(const Patch& patch, double canopy_m) {
    auto fields = std::make_shared<std::vector<std::vector<BladeField>>>(grass::kMarchDensities.size());
    for (std::size_t d = 0; d < grass::kMarchDensities.size(); ++d)
        for (int v = 0; v < patch.variants(); ++v) {
            std::vector<shared::BladeRecord> standing;
            for (const shared::BladeRecord& blade : patch.variant(v))
                if (blade.root.w < grass::kMarchDensities[d])
                    standing.push_back(blade);
            (*fields)[d].emplace_back(standing, patch.looks, patch.side_m, canopy_m);
        }
    return [fields](const SampleRay& ray, std::uint64_t number, double density) -> std::optional<double> {
        const std::size_t d = density < 0.999 ? 1 : 0;
        const std::vector<BladeField>& variants = (*fields)[d];
        const std::optional<RayHit> hit = variants[number % variants.size()].cast(ray.origin, ray.direction);
        return hit ? std::optional<double>(hit->position.y) : std::nullopt;
    };
}

} // namespace sward::texgen
