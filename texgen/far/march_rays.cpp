// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/march_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/angles.h"
#include "shared/march_light.h"
#include "shared/shading.h"

namespace sward::texgen {
namespace {

using shared::kMarchColumns;

const glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
constexpr double kCoverageCounts = 0.75; // of found_at

/// More light, the higher up.
double light_at(double height, double canopy) {
    const double under = 1 - height / canopy;
    return 0.5 * std::exp(-shared::kSunExtinction * under / 0.57) +
           0.5 * std::exp(-shared::kSkyExtinction * under);
}

MarchTexel mix(const MarchTexel& a, const MarchTexel& b, float t) {
    return {std::lerp(a.density, b.density, t), std::lerp(a.albedo, b.albedo, t),
            glm::mix(a.tangent, b.tangent, t)};
}

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
double footprint_of(const MarchCase& which, float side, double width) {
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

} // namespace

double found_at(double height, double canopy) {
    return kCoverageCounts + (1 - kCoverageCounts) * light_at(height, canopy);
}

MarchTexels::MarchTexels(const MarchImages& images, bool repeat_v) : repeat_v_(repeat_v) {
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

MarchTexel MarchTexels::at(glm::vec3 place, float mip) const {
    const float last = static_cast<float>(mips_.size() - 1), m = std::clamp(mip, 0.0f, last);
    const auto low = static_cast<std::size_t>(m);
    const float share = m - static_cast<float>(low);
    const MarchTexel near = in_mip(place, mips_[low]);
    return share > 0 ? mix(near, in_mip(place, mips_[low + 1]), share) : near;
}

MarchTexel MarchTexels::in_mip(glm::vec3 place, const Mip& mip) const {
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
    const MarchTexel* layer =
        mip.texels.data() + static_cast<std::size_t>(place.z) * static_cast<std::size_t>(w * h);
    return mix(mix(layer[y0 * w + x0], layer[y0 * w + x1], a),
               mix(layer[y1 * w + x0], layer[y1 * w + x1], a), b);
}

MarchTextureSet::MarchTextureSet(const MarchData& of) : data(of) {
    for (int kind = 0; kind <= shared::kMarchSets; ++kind)
        kinds.emplace_back(kind == kMarchColumns ? of.columns
                                                 : of.slabs[static_cast<std::size_t>(kind)],
                           kind == kMarchColumns);
}

MarchMean::MarchMean(const MarchTextureSet& textures, const MarchCase& which, int rays)
    : data_(textures.data), texels_(textures.kinds[static_cast<std::size_t>(which.kind)]),
      case_(which), rays_(rays) {
    const MarchData& data = textures.data;
    const double texel = data.medium.side_m / static_cast<double>(shared::kMarchTexels);
    const double softness = shared::kSlabSoftness;
    footprint_ = footprint_of(
        which, data.medium.side_m,
        texel * (which.kind == kMarchColumns
                     ? std::exp2(which.mip)
                     : std::sqrt(std::max(std::exp2(2 * which.mip) - softness * softness, 0.02))));
}

Marched MarchMean::at(double factor, bool light_too) const {
    Marched sum;
    for (int i = 0; i < rays_; ++i) {
        const Marched one = walk(i, static_cast<float>(factor), light_too);
        sum.found += one.found / rays_;
        sum.seen += one.seen / rays_;
        sum.light += one.light / rays_;
    }
    return sum;
}

/// The ray of a sequence that fills places, azimuths and variants evenly, whatever its length
/// (additive recurrence).
shared::MarchPath MarchMean::path_of(int number, float& variant) const {
    constexpr std::array kSteps = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                   0.5385972572236101};
    const auto share = [&](std::size_t n) {
        return std::fmod(0.5 + kSteps[n] * (number + 1), 1.0);
    };
    const double elevation = std::min(case_.elevation_deg, 89.9) * base::kDegree,
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

Marched MarchMean::walk(int number, float factor, bool light_too) const {
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
    for (int n = 0;
         n < shared::kMarchSteps && shared::march_inside(path, at) && through > shared::kMarchEnd;
         ++n) {
        const shared::MarchStep step =
            shared::march_step(medium, path, plan, at, {static_cast<float>(n), scale});
        const glm::vec3 place = shared::march_texel(
            medium, plan, step,
            {step.rest.x / medium.side_m, step.rest.z / medium.side_m, variant});
        const MarchTexel texel = texels_.at(place, step.mip - shared::march_base(plan.kind));
        const double lost =
            through * (1 - std::exp(-shared::march_beside(scale * step.depth * texel.density)));
        const float tint =
            plan.kind == kMarchColumns
                ? glm::dot(shared::march_tint(medium, step.layer, steepness), kLuminance)
                : 1;
        const float height = step.rest.y / medium.canopy_m, whole = std::max(texel.density, 1e-4f);
        out.found += lost * found_at(height, 1);
        if (light_too)
            shared::march_gather(sums, light, light.to_sun.y,
                                 {glm::vec3(tint * texel.albedo / whole),
                                  shared::march_fibre(medium, step, texel.tangent / whole), height,
                                  static_cast<float>(lost)});
        through -= lost;
    }
    out.seen = 1 - through;
    if (light_too)
        out.light = radiance_of(medium, sums, plan, -path.way);
    const double whole = through < shared::kMarchEnd ? 1 / out.seen : 1;
    return {out.found * whole, out.seen * whole, out.light * whole};
}

} // namespace sward::texgen
