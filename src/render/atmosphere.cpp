// SPDX-License-Identifier: Apache-2.0
#include "render/atmosphere.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "shared/sky.h"

namespace sward::render {
namespace {

using glm::dvec3;

// Earth and its air, metres; extinctions a metre at 680, 550 and 440 nm (Hillaire 2020, after
// Bruneton and Neyret 2008).
constexpr double kGround_m = 6.36e6, kTop_m = 6.46e6;
constexpr double kMolecules_m = 8000, kHaze_m = 1200; // scale heights
const dvec3 kMolecules(5.802e-6, 13.558e-6, 33.1e-6);
const dvec3 kOzone(0.650e-6, 1.881e-6, 0.085e-6); // absorbs only; in a layer about 25 km
const dvec3 kFields(0.10, 0.13, 0.05);            // the land's reflectance
constexpr double kHazeWhite = 0.92;               // share of what haze takes out that it scatters
constexpr double kEye_m =
    50; // over the lowest ground: the sky is that of the land, not of a high flight
constexpr double kContrast = 3.912; // -ln 0.02 (Koschmieder)

constexpr double kSunRadius = 0.00465; // of the disc, radians
// Sunlight over the air / pi. The hue is a camera's white balance: a sun of 35 degrees comes
// through as the colours of the shipped sets expect it. The strength sets the brightness of that
// hour; others follow by how far the eye gets used to them.
const dvec3 kSun = 5.0 * dvec3(0.92, 1.0, 1.07);
constexpr double kUsedTo =
    2.42; // light on level ground (irradiance / pi) at which nothing is changed: of that hour
constexpr double kGettingUsed = 0.55; // 0: brightness as it is; 1: every hour is as bright
constexpr double kMostUsed = 4000;    // a night stays dark
constexpr float kBrightestDisc = 60;  // of the picture; what is brighter is white anyway

constexpr int kHeights = 24, kSines = 64, kManyHeights = 8, kManySines = 24, kRaySteps = 32;

dvec3 exp_of(const dvec3& depth) {
    return glm::exp(-depth);
}

double luminance(const dvec3& colour) {
    return glm::dot(colour, dvec3(0.2126, 0.7152, 0.0722));
}

/// Extinction by haze over molecules' at the same place; coarse where the air is thick, as in mist.
dvec3 haze_colour(double visibility_km) {
    const double angstrom = 1.2 * glm::smoothstep(1.0, 20.0, visibility_km);
    return {std::pow(550.0 / 680, angstrom), 1, std::pow(550.0 / 440, angstrom)};
}

/// Sine of the horizon from a height: below it the Earth stands in the way.
double horizon_sine(double height_m) {
    const double share = kGround_m / (kGround_m + height_m);
    return -std::sqrt(std::max(1 - share * share, 0.0));
}

/// Length of a ray from a height up to the top of the air, or down to the ground where it meets
/// that.
double way_length(double height_m, double sine) {
    const double r = kGround_m + height_m;
    const auto to_sphere = [&](double radius, double side) {
        return -r * sine +
               side * std::sqrt(std::max(r * r * (sine * sine - 1) + radius * radius, 0.0));
    };
    return std::max(sine < horizon_sine(height_m) ? to_sphere(kGround_m, -1) : to_sphere(kTop_m, 1),
                    0.0);
}

double height_after(double height_m, double sine, double way_m) {
    const double r = kGround_m + height_m;
    return std::max(std::sqrt(r * r + way_m * way_m + 2 * r * way_m * sine) - kGround_m, 0.0);
}

double ozone_at(double height_m) {
    return std::max(0.0, 1 - std::abs(height_m - 25000) / 15000);
}

/// Place in a table of `count` entries, and the share of the next.
struct Place {
    std::size_t index;
    double share;
    Place(double at, int count)
        : index(static_cast<std::size_t>(std::clamp(at, 0.0, count - 1.0001))),
          share(std::clamp(at, 0.0, count - 1.0) - static_cast<double>(index)) {}
};

dvec3 blend(const std::vector<dvec3>& table, std::size_t columns, const Place& row,
            const Place& column) {
    const dvec3* first = &table[row.index * columns + column.index];
    return glm::mix(glm::mix(first[0], first[1], column.share),
                    glm::mix(first[columns], first[columns + 1], column.share), row.share);
}

double height_row(double height_m, int count) {
    return std::sqrt(std::max(height_m, 0.0) / (kTop_m - kGround_m)) * (count - 1);
}
double row_height(int row, int count) {
    return (kTop_m - kGround_m) * row * row / ((count - 1.0) * (count - 1.0));
}

/// Share of the disc over the horizon of a height.
double disc_over_horizon(double height_m, double sine) {
    return glm::smoothstep(-kSunRadius, kSunRadius,
                           std::asin(std::clamp(sine, -1.0, 1.0)) -
                               std::asin(horizon_sine(height_m)));
}

/// Ways all round, evenly spread (a Fibonacci lattice).
dvec3 spread_way(int n, int count) {
    const double y = 1 - (2 * n + 1.0) / count, flat = std::sqrt(1 - y * y),
                 turn = 2.399963229728653 * n;
    return {flat * std::cos(turn), y, flat * std::sin(turn)};
}

} // namespace

Atmosphere::Atmosphere(double visibility_km) {
    const double haze = std::max(kContrast / (1000 * visibility_km) - kMolecules.y, 1e-7);
    haze_extinction_ = haze * haze_colour(visibility_km);
    haze_scattering_ = kHazeWhite * haze_extinction_;
    sunlight_.resize(kHeights * kSines);
    for (int i = 0; i < kHeights; ++i) {
        const double from_m = row_height(i, kHeights), lowest = horizon_sine(from_m);
        for (int j = 0; j < kSines; ++j) {
            const double u = j / (kSines - 1.0), sine = lowest + (1 - lowest) * u * u,
                         length_m = way_length(from_m, sine + 1e-12);
            dvec3 depth(0);
            for (int n = 0; n < kRaySteps; ++n) {
                const double a = n / double{kRaySteps}, b = (n + 1) / double{kRaySteps},
                             step_m = length_m * (b * b - a * a);
                const double height_m =
                    height_after(from_m, sine, length_m * 0.5 * (a * a + b * b));
                depth += step_m * (kMolecules * std::exp(-height_m / kMolecules_m) +
                                   haze_extinction_ * std::exp(-height_m / kHaze_m) +
                                   kOzone * ozone_at(height_m));
            }
            sunlight_[static_cast<std::size_t>(i * kSines + j)] = exp_of(depth);
        }
    }
    many_.resize(kManyHeights * kManySines);
    for (int i = 0; i < kManyHeights; ++i) {
        for (int j = 0; j < kManySines; ++j) {
            const double u = 2 * j / (kManySines - 1.0) - 1; // dense at the horizon
            many_[static_cast<std::size_t>(i * kManySines + j)] =
                bounce(std::max(row_height(i, kManyHeights), 1.0), u * std::abs(u));
        }
    }
}

dvec3 Atmosphere::sunlight(double height_m, double sine) const {
    const double lowest = horizon_sine(height_m);
    const double u = std::sqrt(std::max((sine - lowest) / (1 - lowest), 0.0));
    return disc_over_horizon(height_m, sine) *
           blend(sunlight_, kSines, Place(height_row(height_m, kHeights), kHeights),
                 Place(u * (kSines - 1), kSines));
}

dvec3 Atmosphere::many(double height_m, double sine) const {
    const double u = std::copysign(std::sqrt(std::abs(sine)), sine);
    return blend(many_, kManySines, Place(height_row(height_m, kManyHeights), kManyHeights),
                 Place(0.5 * (u + 1) * (kManySines - 1), kManySines));
}

/// Light that has been scattered twice and more, where all air about is lit as here: one round of
/// it over what each further round leaves.
dvec3 Atmosphere::bounce(double height_m, double sine) const {
    constexpr int kWays = 32, kSteps = 12;
    const dvec3 to_sun(std::sqrt(std::max(1 - sine * sine, 0.0)), sine, 0);
    dvec3 twice(0), again(0);
    for (int w = 0; w < kWays; ++w) {
        const dvec3 way = spread_way(w, kWays);
        const double length_m = way_length(height_m, way.y);
        dvec3 through(1);
        for (int n = 0; n < kSteps; ++n) {
            const double a = n / double{kSteps}, b = (n + 1) / double{kSteps},
                         step_m = length_m * (b * b - a * a),
                         at_m = length_m * 0.5 * (a * a + b * b);
            const dvec3 place = dvec3(0, kGround_m + height_m, 0) + at_m * way;
            const double r = glm::length(place), here_m = std::max(r - kGround_m, 0.0);
            const double molecules = std::exp(-here_m / kMolecules_m),
                         haze = std::exp(-here_m / kHaze_m);
            const dvec3 scattering = kMolecules * molecules + haze_scattering_ * haze;
            const dvec3 left = exp_of(step_m * (kMolecules * molecules + haze_extinction_ * haze +
                                                kOzone * ozone_at(here_m)));
            const dvec3 share = through * scattering * step_m * glm::sqrt(left);
            twice +=
                share * sunlight(here_m, glm::dot(place, to_sun) / r) * (0.25 / glm::pi<double>());
            again += share;
            through *= left;
        }
        if (way.y < horizon_sine(height_m)) {
            const dvec3 foot = glm::normalize(dvec3(0, kGround_m + height_m, 0) + length_m * way);
            const double on_it = glm::dot(foot, to_sun);
            twice +=
                through * kFields * sunlight(0, on_it) * (std::max(on_it, 0.0) / glm::pi<double>());
        }
    }
    return twice / double{kWays} / (1.0 - again / double{kWays});
}

Atmosphere::Scattered Atmosphere::gather(const dvec3& way, const dvec3& to_sun) const {
    const double length_m = way_length(kEye_m, std::max(way.y, horizon_sine(kEye_m) + 1e-9));
    Scattered sum;
    dvec3 through(1);
    for (int n = 0; n < kRaySteps; ++n) {
        const double a = n / double{kRaySteps}, b = (n + 1) / double{kRaySteps},
                     step_m = length_m * (b * b - a * a), at_m = length_m * 0.5 * (a * a + b * b);
        const dvec3 place = dvec3(0, kGround_m + kEye_m, 0) + at_m * way;
        const double r = glm::length(place), here_m = std::max(r - kGround_m, 0.0),
                     sine = glm::dot(place, to_sun) / r;
        const dvec3 molecules = kMolecules * std::exp(-here_m / kMolecules_m);
        const double haze = std::exp(-here_m / kHaze_m);
        const dvec3 depth =
            step_m * (molecules + haze_extinction_ * haze + kOzone * ozone_at(here_m));
        const dvec3 left = exp_of(depth);
        const dvec3 share = through * step_m * (1.0 - left) /
                            glm::max(depth, dvec3(1e-12)); // exact where the step's air is even
        const dvec3 lit = sunlight(here_m, sine) * share;
        sum.molecules += lit * molecules;
        sum.haze += lit * haze_scattering_ * haze;
        sum.many += share * (molecules + haze_scattering_ * haze) * many(here_m, sine);
        through *= left;
    }
    return sum;
}

Atmosphere::Day Atmosphere::day(const dvec3& to_sun) const {
    Day day;
    shared::Air& air = day.air;
    const double flat = std::sqrt(std::max(1 - to_sun.y * to_sun.y, 0.0));
    const dvec3 level = flat > 1e-6 ? dvec3(to_sun.x, 0, to_sun.z) / flat : dvec3(1, 0, 0);
    air.to_sun = glm::vec3(to_sun);
    air.molecules_per_m = static_cast<float>(1 / kMolecules_m);
    air.level_sun = glm::vec3(level);
    air.haze_per_m = static_cast<float>(1 / kHaze_m);
    air.molecules = glm::vec4(glm::vec3(kMolecules), 0);
    air.haze = glm::vec4(glm::vec3(haze_extinction_), 0);
    const dvec3 direct = kSun * sunlight(kEye_m, to_sun.y);
    for (int i = 0; i < shared::kSkyRows; ++i) {
        const double u = i / (shared::kSkyRows - 1.0), sine = u * u,
                     out = std::sqrt(1 - sine * sine);
        const Scattered near = gather(out * level + dvec3(0, sine, 0), to_sun),
                        away = gather(-out * level + dvec3(0, sine, 0), to_sun);
        const auto put = [&](dvec3 toward, dvec3 from, glm::vec4& mean, glm::vec4& turn) {
            mean = glm::vec4(glm::vec3(glm::pi<double>() * kSun * 0.5 * (toward + from)), 0);
            turn = glm::vec4(glm::vec3(glm::pi<double>() * kSun * 0.5 * (toward - from)), 0);
        };
        shared::SkyRow& row = air.sky[i];
        put(near.molecules, away.molecules, row.molecules, row.molecules_turn);
        put(near.haze, away.haze, row.haze, row.haze_turn);
        put(near.many, away.many, row.many, row.many_turn);
    }
    // The sky's light on level ground, and what it is near the horizon.
    constexpr int kWays = 512;
    dvec3 from_sky(0), low(0);
    for (int n = 0; n < kWays; ++n) {
        const dvec3 way = spread_way(n, 2 * kWays); // the upper half
        from_sky += dvec3(shared::sky_radiance(air, glm::vec3(way))) * (2 * way.y / kWays);
    }
    for (int n = 0; n < 16; ++n) {
        const double turn = glm::two_pi<double>() * n / 16, sine = 0.15,
                     out = std::sqrt(1 - sine * sine);
        low +=
            dvec3(shared::sky_radiance(air, {out * std::cos(turn), sine, out * std::sin(turn)})) /
            16.0;
    }
    const double level_light = luminance(direct * std::max(to_sun.y, 0.0) + from_sky);
    const double used =
        std::min(std::pow(kUsedTo / std::max(level_light, 1e-9), kGettingUsed), kMostUsed);
    for (shared::SkyRow& row : air.sky) {
        for (glm::vec4* part : {&row.molecules, &row.molecules_turn, &row.haze, &row.haze_turn,
                                &row.many, &row.many_turn}) {
            *part *= static_cast<float>(used);
        }
    }
    day.light.to_sun = glm::vec3(to_sun);
    day.light.sun_extinction = shared::kSunExtinction;
    day.light.sun = glm::vec3(direct * used);
    day.light.zenith = glm::vec3(from_sky * used);
    day.light.sky_extinction = shared::kSkyExtinction;
    day.light.horizon = glm::vec3(low * used);
    const glm::vec3 disc(direct * used / (kSunRadius * kSunRadius));
    const float brightest = std::max({disc.x, disc.y, disc.z, 1e-9f});
    air.disc = disc * std::min(1.0f, kBrightestDisc / brightest);
    air.disc_radius = kSunRadius;
    return day;
}

const Atmosphere::Day& Atmosphere::at(const dvec3& to_sun) {
    if (to_sun != last_sun_) {
        last_ = day(to_sun);
        last_sun_ = to_sun;
    }
    return last_;
}

shared::Air Atmosphere::thinned(shared::Air air, double height_m) {
    const double up = std::max(height_m, 0.0);
    air.molecules *= static_cast<float>(std::exp(-up / kMolecules_m));
    air.haze *= static_cast<float>(std::exp(-up / kHaze_m));
    return air;
}

} // namespace sward::render
