// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/far_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/angles.h"
#include "shared/bend.h"
#include "shared/shading.h"

namespace sward::texgen {
namespace {

using base::kDegree;
// Intensities of the shipped meadow in a calm, and in wind of some 7, 13 and 35 m/s. 45 degrees of
// lean azimuth and 22.5 of the sun's: finer changed a meadow's radiance by less than the rays' own
// error. Low suns are close, for there sunlight fades.
const std::vector<float> kLeans = {0.0f, 0.3f, 0.6f, 0.9f};
const std::vector<float> kLeanAzimuths = {0, 45, 90, 135, 180};
const std::vector<float> kSunElevations = {-5, -1, 3, 7, 12, 20, 30, 45, 60, 90};
constexpr int kSunAzimuths = 16;

glm::dvec3 direction(double elevation_deg, double azimuth_deg) {
    const double e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

/// The suns of the table in the view's frame, where the eye's azimuth is 0.
std::vector<shared::Light> suns() {
    std::vector<shared::Light> lights;
    for (const float elevation : kSunElevations)
        for (int a = 0; a < kSunAzimuths; ++a) {
            shared::Light light{};
            light.to_sun = glm::vec3(direction(elevation, 360.0 * a / kSunAzimuths));
            light.sun_extinction = shared::kSunExtinction;
            light.sun = glm::vec3(1);
            light.sky_extinction = shared::kSkyExtinction;
            lights.push_back(light);
        }
    return lights;
}

/// Sky alone; where the sun stands does not matter to it.
shared::Light even_sky() {
    shared::Light light{};
    light.to_sun = {0, 1, 0};
    light.sun_extinction = shared::kSunExtinction;
    light.zenith = light.horizon = glm::vec3(1);
    light.sky_extinction = shared::kSkyExtinction;
    return light;
}

/// The tangent in the view's frame, mirrored if asked: shading knows angles between tangent, sun
/// and eye alone.
glm::vec3 seen_from(const glm::vec3& tangent, const glm::dvec3& to_eye, bool mirrored) {
    const glm::dvec2 flat(to_eye.x, to_eye.z);
    const double length = glm::length(flat);
    const glm::dvec2 h = length > 1e-9 ? flat / length : glm::dvec2(1, 0);
    const double across = tangent.z * h.x - tangent.x * h.y;
    return {tangent.x * h.x + tangent.z * h.y, tangent.y, mirrored ? -across : across};
}

/// Where a bend of this intensity along +x turns an upright blade, at the height where sway_at
/// takes it.
glm::vec3 lean_turn(double lean) {
    const double angle = 0.5 * std::numbers::pi * lean * shared::kSwayHeight;
    return {std::sin(angle), std::cos(angle), 0};
}

/// The suns as they reach the bent canopy (canopy_sway), for both mirror images.
class SwayedLights {
public:
    SwayedLights(const std::vector<shared::GrassAppearance>& looks,
                 const std::vector<shared::Light>& lights, const ViewRays& view,
                 const glm::vec3& to_eye)
        : count_(lights.size()) {
        for (const bool mirrored : {false, true}) {
            const double azimuth = view.lean_azimuth_deg.value_or(0);
            const glm::vec3 turn = seen_from(lean_turn(view.lean),
                                             direction(0, mirrored ? azimuth : -azimuth), mirrored);
            for (const shared::Light& light : lights)
                lights_.push_back(shared::light_in_sway(
                    light, shared::canopy_sway(looks.front(), turn, light.to_sun, to_eye)));
        }
    }
    [[nodiscard]] const shared::Light& at(bool mirrored, std::size_t sun) const {
        return lights_[(mirrored ? count_ : 0) + sun];
    }

private:
    std::size_t count_;
    std::vector<shared::Light> lights_;
};

SampleRay ray_of(const Canopy& canopy, const ViewRays& view, int number, bool mirrored) {
    SampleRay ray = sample_ray(number, view.elevation_deg, canopy.side_m, canopy.top_m);
    if (view.lean_azimuth_deg) // the canopy leans along +x, that far from the eye
        ray.direction = -direction(view.elevation_deg,
                                   mirrored ? *view.lean_azimuth_deg : -*view.lean_azimuth_deg);
    return ray;
}

/// Blades of one variant, at rest and bent.
struct BentBlades {
    std::span<const shared::BladeRecord> rest;
    std::vector<shared::BladeRecord> bent;
    const Patch& patch;
    double canopy_m;
    std::optional<BladeField> field;

    BentBlades(const Patch& whole, int variant, double canopy, double lean)
        : rest(whole.variant(variant)), bent(rest.begin(), rest.end()), patch(whole),
          canopy_m(canopy) {
        // The wind of 1 m/s along x whose bend_intensity is `lean`.
        const auto response = static_cast<float>(std::sqrt(std::pow(1 - lean, -1.5) - 1));
        for (shared::BladeRecord& blade : bent) {
            if (lean <= 0)
                break;
            glm::vec3 v1(blade.v1), v2(blade.v2);
            shared::pose_blade(v1, v2, {blade.shape.y, static_cast<float>(canopy), response, 1},
                               {1, 0});
            blade.v1 = {v1, blade.v1.w};
            blade.v2 = {v2, blade.v2.w};
        }
        field.emplace(bent, patch.looks, patch.side_m, canopy);
    }

    [[nodiscard]] std::optional<GrassHit> cast(const SampleRay& ray) const {
        const std::optional<RayHit> hit = field->cast(ray.origin, ray.direction);
        if (!hit)
            return std::nullopt;
        const shared::BladeRecord& own = rest[hit->blade];
        const shared::BladeRecord& posed = bent[hit->blade];
        const std::size_t species = species_of(own);
        const auto v = static_cast<float>(hit->along);
        const double y = shared::blade_curve(glm::vec3(own.v1), glm::vec3(own.v2), v).y;
        return GrassHit{shared::blade_albedo(patch.looks[species], {own.root.z, own.root.w}, v, 0),
                        shared::blade_tangent(glm::vec3(posed.v1), glm::vec3(posed.v2), v),
                        std::clamp(y / canopy_m, 0.0, 1.0), hit->along, species};
    }
};

} // namespace

Canopy blade_canopy(const Patch& patch, double canopy_m) {
    return {patch.side_m, canopy_m, patch.looks, [&patch, canopy_m](double lean) {
                std::vector<Caster> casters;
                for (int v = 0; v < patch.variants(); ++v)
                    casters.emplace_back(
                        [blades = std::make_shared<BentBlades>(patch, v, canopy_m, lean)](
                            const SampleRay& ray, std::uint64_t) { return blades->cast(ray); });
                return casters;
            }};
}

void ViewSums::add(const ViewSums& other) {
    rays += other.rays;
    hits += other.hits;
    shaded += other.shaded;
    height += other.height;
    along += other.along;
    sky += other.sky;
    sun.resize(std::max(sun.size(), other.sun.size()), glm::dvec3(0));
    for (std::size_t i = 0; i < other.sun.size(); ++i)
        sun[i] += other.sun[i];
}

ViewSums cast_view(const Canopy& canopy, const std::vector<Caster>& casters, const ViewRays& view) {
    const std::vector<shared::Light> lights = suns();
    const shared::Light sky = even_sky();
    const glm::vec3 to_eye(direction(view.elevation_deg, 0));
    const SwayedLights swayed(canopy.looks, lights, view, to_eye);
    ViewSums sums;
    sums.sun.resize(lights.size(), glm::dvec3(0));
    for (int i = view.first; i < view.end; ++i) {
        const bool mirrored = i % 2 == 1;
        const Caster& caster = casters[static_cast<std::size_t>(i) * casters.size() /
                                       static_cast<std::size_t>(view.count)];
        const SampleRay ray = ray_of(canopy, view, i, mirrored);
        ++sums.rays;
        const std::optional<GrassHit> hit = caster(ray, static_cast<std::uint64_t>(i));
        if (!hit)
            continue;
        sums.height += hit->height;
        sums.along += hit->along;
        if (sums.hits++ % view.shade_every != 0)
            continue;
        ++sums.shaded;
        const shared::GrassAppearance& look = canopy.looks[hit->species];
        shared::GrassPoint point{hit->albedo, seen_from(hit->tangent, -ray.direction, mirrored),
                                 static_cast<float>(hit->height), 1};
        sums.sky += shared::shade_grass(look, sky, point, to_eye);
        for (std::size_t s = 0; s < lights.size(); ++s) {
            point.slope = lights[s].to_sun.y;
            sums.sun[s] += shared::shade_grass(look, swayed.at(mirrored, s), point, to_eye);
        }
    }
    return sums;
}

grass::FarLight light_axes(const std::vector<float>& elevations_deg) {
    grass::FarLight light{kLeans, kLeanAzimuths, elevations_deg, kSunElevations, kSunAzimuths, {}};
    light.samples.resize(light.images() * kSunElevations.size() * kSunAzimuths);
    return light;
}

void store_view(const ViewSums& sums, bool even, std::size_t image, grass::FarLight& light) {
    const double hits = std::max(sums.hits, 1), shaded = std::max(sums.shaded, 1);
    for (std::size_t s = 0; s < kSunElevations.size(); ++s)
        for (std::size_t a = 0; a < kSunAzimuths; ++a) {
            const auto sun = [&](std::size_t azimuth) {
                return sums.sun[s * kSunAzimuths + azimuth] / shaded;
            };
            grass::FarSample& out = light.samples[light.at(image, s, a)];
            out.sun = even ? 0.5 * (sun(a) + sun((kSunAzimuths - a) % kSunAzimuths)) : sun(a);
            out.sky = sums.sky / shaded;
            out.coverage =
                static_cast<float>(sums.hits) / static_cast<float>(std::max(sums.rays, 1));
            out.height = static_cast<float>(sums.height / hits);
        }
}

scene::Image far_light_picture(const grass::FarLight& light) {
    const std::size_t columns =
        light.sun_elevations_deg.size() * static_cast<std::size_t>(light.sun_azimuths);
    scene::Image picture{
        static_cast<int>(columns),
        static_cast<int>(light.images()),
        {"sun.R", "sun.G", "sun.B", "sky.R", "sky.G", "sky.B", "coverage", "height"},
        {},
        {}};
    for (const grass::FarSample& s : light.samples)
        picture.texels.insert(picture.texels.end(), {s.sun.x, s.sun.y, s.sun.z, s.sky.x, s.sky.y,
                                                     s.sky.z, s.coverage, s.height});
    std::vector<float> azimuths;
    for (int a = 0; a < light.sun_azimuths; ++a)
        azimuths.push_back(360.0f * static_cast<float>(a) / static_cast<float>(light.sun_azimuths));
    const auto list = [](const std::vector<float>& values) {
        return fmt::format("{}", fmt::join(values, " "));
    };
    picture.metadata = {{"sward:leans", list(light.leans)},
                        {"sward:lean_azimuths_deg", list(light.lean_azimuths_deg)},
                        {"sward:elevations_deg", list(light.elevations_deg)},
                        {"sward:sun_elevations_deg", list(light.sun_elevations_deg)},
                        {"sward:sun_azimuths_deg", list(azimuths)},
                        {"sward:rows", "view elevation within lean azimuth within lean"},
                        {"sward:columns", "sun azimuth within sun elevation"}};
    return picture;
}

} // namespace sward::texgen
