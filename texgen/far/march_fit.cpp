// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/march_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "base/log.h"
#include "shared/march_light.h"
#include "shared/shading.h"
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
const glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);

/// What a ray that ends at this height brings: mostly that it has met grass, and a little how high
/// up, where there is more light. Any such function would do whose mean tells both how much is seen
/// of the grass and how deep; coverage has to be right where ground is seen.
double light_at(double height, double canopy) {
    const double under = 1 - height / canopy;
    return 0.5 * std::exp(-shared::kSunExtinction * under / 0.57) +
           0.5 * std::exp(-shared::kSkyExtinction * under);
}
constexpr double kCoverageCounts = 0.75;
double found_at(double height, double canopy) {
    return kCoverageCounts + (1 - kCoverageCounts) * light_at(height, canopy);
}

/// What the march reads of a texel.
struct Texel {
    float density = 0;
    float albedo = 0;     ///< luminance, times the density
    glm::vec3 tangent{0}; ///< likewise
};

Texel mix(const Texel& a, const Texel& b, float t) {
    return {std::lerp(a.density, b.density, t), std::lerp(a.albedo, b.albedo, t),
            glm::mix(a.tangent, b.tangent, t)};
}

/// What a ray reads of one of the march's textures, mip by mip.
class Texels {
public:
    Texels(const MarchImages& images, bool repeat_v) : repeat_v_(repeat_v) {
        for (std::size_t i = 0; i < images.mips.size(); ++i) {
            Mip mip{std::max(1, images.width >> i), std::max(1, images.height >> i), {}};
            for (std::size_t at = 0; at < images.mips[i].size(); at += MarchImages::kFloats) {
                const float* sums = &images.mips[i][at];
                mip.texels.push_back({sums[MarchImages::kDensity],
                                      glm::dot(glm::vec3(sums[0], sums[1], sums[2]), kLuminance),
                                      {sums[4], sums[5], sums[6]}});
            }
            mips_.push_back(std::move(mip));
        }
    }
    /// Trilinear, repeating along u and, if asked, along v: as the GPU reads it.
    [[nodiscard]] Texel at(glm::vec3 place, float mip) const {
        const float last = static_cast<float>(mips_.size() - 1), m = std::clamp(mip, 0.0f, last);
        const auto low = static_cast<std::size_t>(m);
        const float share = m - static_cast<float>(low);
        const Texel near = in_mip(place, mips_[low]);
        return share > 0 ? mix(near, in_mip(place, mips_[low + 1]), share) : near;
    }

private:
    struct Mip {
        int width, height;
        std::vector<Texel> texels;
    };
    [[nodiscard]] Texel in_mip(glm::vec3 place, const Mip& mip) const {
        const int w = mip.width, h = mip.height;
        const float u = (place.x - std::floor(place.x)) * static_cast<float>(w) - 0.5f;
        const float v =
            (repeat_v_ ? place.y - std::floor(place.y) : place.y) * static_cast<float>(h) - 0.5f;
        const float left = std::floor(u), down = std::floor(v);
        const float a = u - left, b = v - down;
        // u is within [-0.5, w - 0.5]: one step over an end comes back at the other.
        const auto around = [](int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; };
        const auto column = static_cast<int>(left), row = static_cast<int>(down);
        const int x0 = around(column, w), x1 = around(column + 1, w);
        const int y0 = repeat_v_ ? around(row, h) : std::clamp(row, 0, h - 1),
                  y1 = repeat_v_ ? around(row + 1, h) : std::clamp(row + 1, 0, h - 1);
        const Texel* layer =
            mip.texels.data() + static_cast<std::size_t>(place.z) * static_cast<std::size_t>(w * h);
        return mix(mix(layer[y0 * w + x0], layer[y0 * w + x1], a),
                   mix(layer[y1 * w + x0], layer[y1 * w + x1], a), b);
    }
    std::vector<Mip> mips_;
    bool repeat_v_;
};

/// A set's march and its textures as rays read them, by kind.
struct Textures {
    const MarchData& data;
    std::vector<Texels> kinds;

    explicit Textures(const MarchData& of) : data(of) {
        for (int kind = 0; kind <= shared::kMarchSets; ++kind)
            kinds.emplace_back(kind == kMarchColumns ? of.columns
                                                     : of.slabs[static_cast<std::size_t>(kind)],
                               kind == kMarchColumns);
    }
};

struct Case {
    int kind = 0;
    double mip = 0, elevation_deg = 0, density = 1;
};

/// Sums over marched rays.
struct Marched {
    double found = 0; ///< found_at of what they meet
    double seen = 0;  ///< share of the view that is grass
    double light = 0; ///< of that: its radiance, as the march shades it
};

/// Sunlight from so high up, from kSuns sides in turn, and skylight.
constexpr int kSuns = 4;
shared::Light sun_from(int side) {
    constexpr float kElevation = 40 * shared::kPi / 180, kSky = 0.2f;
    const float azimuth = 2 * shared::kPi * (static_cast<float>(side) + 0.5f) / kSuns;
    shared::Light light{};
    light.to_sun = {std::cos(kElevation) * std::cos(azimuth), std::sin(kElevation),
                    std::cos(kElevation) * std::sin(azimuth)};
    light.sun_extinction = shared::kSunExtinction;
    light.sun = glm::vec3(1);
    light.zenith = light.horizon = glm::vec3(kSky);
    light.sky_extinction = shared::kSkyExtinction;
    return light;
}

/// Radiance of a ray's sums toward the eye, mean over the suns.
double radiance_of(const shared::MarchMedium& medium, const shared::GrassSums& gathered,
                   const shared::MarchPlan& plan, const glm::vec3& to_eye) {
    double sum = 0;
    for (int side = 0; side < kSuns; ++side) {
        const shared::Light light = sun_from(side);
        shared::GrassSums sums = gathered;
        shared::march_stand(medium, sums, light, {plan.elevation, 0, light.to_sun.y}, to_eye);
        sum += shared::march_radiance(medium, light, sums, to_eye).y;
    }
    return sum / kSuns;
}

/// Footprint that reads so wide a part of its texture (m): march_width's inverse, which rises.
double footprint_of(const Case& which, float side, double width) {
    double low = width,
           high = width *
                  std::exp2(-static_cast<double>(std::min(shared::kSlabBias, shared::kColumnBias)));
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (shared::march_width(which.kind, static_cast<float>(middle), side,
                             static_cast<float>(which.elevation_deg)) < width
             ? low
             : high) = middle;
    }
    return high;
}

/// Means of what the march sees with a factor.
class MarchMean {
public:
    MarchMean(const Textures& textures, const Case& which, int rays)
        : data_(textures.data), texels_(textures.kinds[static_cast<std::size_t>(which.kind)]),
          case_(which), rays_(rays) {
        const MarchData& data = textures.data;
        const double texel = data.medium.side_m / static_cast<double>(shared::kMarchTexels);
        const double softness = shared::kSlabSoftness;
        footprint_ = footprint_of(
            which, data.medium.side_m,
            texel *
                (which.kind == kMarchColumns
                     ? std::exp2(which.mip)
                     : std::sqrt(std::max(std::exp2(2 * which.mip) - softness * softness, 0.02))));
    }
    [[nodiscard]] Marched at(double factor, bool light_too = false) const {
        Marched sum;
        for (int i = 0; i < rays_; ++i) {
            const Marched one = walk(i, static_cast<float>(factor), light_too);
            sum.found += one.found / rays_;
            sum.seen += one.seen / rays_;
            sum.light += one.light / rays_;
        }
        return sum;
    }

private:
    /// The ray of a sequence that fills places, azimuths and variants evenly, whatever its length
    /// (additive recurrence).
    [[nodiscard]] shared::MarchPath path_of(int number, float& variant) const {
        constexpr std::array kSteps = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                       0.5385972572236101};
        const auto share = [&](std::size_t n) {
            return std::fmod(0.5 + kSteps[n] * (number + 1), 1.0);
        };
        const double elevation = std::min(case_.elevation_deg, 89.9) * std::numbers::pi / 180,
                     azimuth = share(2) * 2 * std::numbers::pi;
        const shared::MarchMedium& medium = data_.medium;
        variant = std::floor(static_cast<float>(share(3)) * static_cast<float>(medium.variants));
        const glm::vec3 way(std::cos(elevation) * std::cos(azimuth), -std::sin(elevation),
                            std::cos(elevation) * std::sin(azimuth));
        shared::MarchPath path;
        path.from = {static_cast<float>(share(0)) * medium.side_m, medium.canopy_m,
                     static_cast<float>(share(1)) * medium.side_m};
        path.way = way;
        path.height = {medium.canopy_m, way.y, 0, -medium.canopy_m / way.y};
        path.bend = {1, 0, 0, medium.canopy_m};
        return path;
    }

    [[nodiscard]] Marched walk(int number, float factor, bool light_too) const {
        const shared::MarchMedium& medium = data_.medium;
        float variant = 0;
        const shared::MarchPath path = path_of(number, variant);
        constexpr float kFar = 1000;
        shared::MarchPlan plan = shared::march_look(
            medium, path,
            {static_cast<float>(footprint_) / kFar, kFar, static_cast<float>(case_.density)});
        plan.footprint = static_cast<float>(footprint_);
        plan.kind = case_.kind;
        plan.axis = std::abs(plan.level.x) > std::abs(plan.level.y) ? 0 : 1;
        shared::march_settle(medium, plan);
        const float scale = factor * plan.density,
                    steepness = shared::march_steepness(medium, plan, path.way.y);
        shared::MarchWalk at = shared::march_begin(path);
        const shared::Light light = sun_from(0); // its height alone counts on the way
        shared::GrassSums sums = shared::march_nothing();
        double through = 1;
        Marched out;
        for (int n = 0; n < shared::kMarchSteps && shared::march_inside(path, at) &&
                        through > shared::kMarchEnd;
             ++n) {
            const shared::MarchStep step =
                shared::march_step(medium, path, plan, at, {static_cast<float>(n), scale});
            const glm::vec3 place = shared::march_texel(
                medium, plan, step,
                {step.rest.x / medium.side_m, step.rest.z / medium.side_m, variant});
            const Texel texel = texels_.at(place, step.mip - shared::march_base(plan.kind));
            const double lost =
                through * (1 - std::exp(-shared::march_beside(scale * step.depth * texel.density)));
            const float tint =
                plan.kind == kMarchColumns
                    ? glm::dot(shared::march_tint(medium, step.layer, steepness), kLuminance)
                    : 1;
            const float height = step.rest.y / medium.canopy_m,
                        whole = std::max(texel.density, 1e-4f);
            out.found += lost * found_at(height, 1);
            if (light_too)
                shared::march_gather(sums, light, light.to_sun.y,
                                     {glm::vec3(tint * texel.albedo / whole),
                                      shared::march_fibre(medium, step, texel.tangent / whole),
                                      height, static_cast<float>(lost)});
            through -= lost;
        }
        out.seen = 1 - through;
        if (light_too)
            out.light = radiance_of(medium, sums, plan, -path.way);
        const double whole = through < shared::kMarchEnd ? 1 / out.seen : 1;
        return {out.found * whole, out.seen * whole, out.light * whole};
    }

    const MarchData& data_;
    const Texels& texels_;
    Case case_;
    int rays_;
    double footprint_;
};

double true_mean(const MarchData& data, const HeightCaster& truth, const Case& which, int rays) {
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
    const Textures textures(data);
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
