// SPDX-License-Identifier: Apache-2.0
// Air: the sun's light through it, the sky by hour and direction, distance; the shadow of the land
// against lengths known by trigonometry.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "render/atmosphere.h"
#include "shared/sky.h"
#include "terrain/sun_sweep.h"

namespace sward {
namespace {

using shared::vec2;
using shared::vec3;
using terrain::SunSweep;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// The sun so high in the azimuth (degrees, 0 north, 90 east).
glm::dvec3 sun_at(double elevation_deg, double azimuth_deg = 90) {
    const double up = elevation_deg * kDegree, turn = azimuth_deg * kDegree;
    return {std::sin(turn) * std::cos(up), std::sin(up), -std::cos(turn) * std::cos(up)};
}

double luminance(const vec3& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

bool usable(const vec3& radiance) {
    return std::isfinite(radiance.x) && std::isfinite(radiance.y) && std::isfinite(radiance.z) &&
           radiance.x >= 0 && radiance.y >= 0 && radiance.z >= 0;
}

render::Atmosphere& clear_air() {
    static render::Atmosphere air(60);
    return air;
}

TEST(Air, PhaseFunctionsGiveBackWhatComesIn) {
    double molecules = 0, haze = 0, forward = 0;
    constexpr int kSteps = 20000;
    for (int n = 0; n < kSteps; ++n) {
        const float c = -1 + 2 * (static_cast<float>(n) + 0.5f) / kSteps;
        molecules += shared::phase_of_molecules(c) * 4 * 3.14159265 / kSteps;
        haze += shared::phase_of_haze(c) * 4 * 3.14159265 / kSteps;
        forward += c * shared::phase_of_haze(c) * 4 * 3.14159265 / kSteps;
    }
    EXPECT_NEAR(molecules, 1, 1e-3);
    EXPECT_NEAR(haze, 1, 1e-3);
    EXPECT_GT(forward, 0.7); // on
}

TEST(Air, TheSunsLightIsWhatTheOpticalDepthLeaves) {
    // At the zenith the depth is the layers' own: molecules and haze times their scale heights,
    // ozone a triangle of 15 km to each side.
    const double haze = 3.912 / 60000 - 13.558e-6;
    const double depth = 13.558e-6 * 8000 * std::exp(-50.0 / 8000) +
                         haze * 1200 * std::exp(-50.0 / 1200) + 1.88e-6 * 15000;
    EXPECT_NEAR(clear_air().sunlight(50, 1).y, std::exp(-depth), 0.01);
    // Lower, by the mass of air of Kasten and Young 1989, but for the layers' different heights.
    for (const double elevation_deg : {35.0, 15.0, 8.0}) {
        const double mass = 1 / (std::sin(elevation_deg * kDegree) +
                                 0.50572 * std::pow(elevation_deg + 6.07995, -1.6364));
        EXPECT_NEAR(std::log(clear_air().sunlight(50, std::sin(elevation_deg * kDegree)).y) /
                        -depth,
                    mass, 0.06 * mass)
            << elevation_deg;
    }
    EXPECT_EQ(clear_air().sunlight(50, std::sin(-2 * kDegree)), glm::dvec3(0)); // behind the Earth
    EXPECT_GT(clear_air().sunlight(20000, std::sin(-2 * kDegree)).x,
              0.1); // which a high place looks over
}

TEST(Air, TheSunReddensAndTheSkyDarkensAsItSinks) {
    double red_before = 0, sky_before = 1e9;
    for (const double elevation_deg : {60.0, 35.0, 20.0, 10.0, 5.0, 2.0, 0.5}) {
        const render::Atmosphere::Day day = clear_air().at(sun_at(elevation_deg));
        const double red = day.light.sun.x / std::max(day.light.sun.z, 1e-9f);
        EXPECT_GT(red, red_before) << elevation_deg;
        red_before = red;
    }
    for (const double elevation_deg : {10.0, 0.0, -4.0, -8.0, -12.0}) {
        const render::Atmosphere::Day day = clear_air().at(sun_at(elevation_deg));
        const double sky = luminance(day.light.zenith);
        EXPECT_LT(sky, sky_before) << elevation_deg;
        EXPECT_GT(sky, 0) << elevation_deg;
        sky_before = sky;
        EXPECT_TRUE(elevation_deg > -0.3 || vec3(day.light.sun) == vec3(0)) << elevation_deg;
    }
    const vec3 dusk_sky = shared::sky_radiance(clear_air().at(sun_at(-4)).air, vec3(0, 1, 0));
    EXPECT_GT(dusk_sky.z, 1.5 * dusk_sky.x); // ozone: the sky overhead stays blue
}

TEST(Air, TheUsualSunIsAsBrightAsTheSetsWereTunedTo) {
    const render::Atmosphere::Day day = clear_air().at(sun_at(35));
    EXPECT_NEAR(day.light.sun.x, 3.78, 0.04 * 3.78);
    EXPECT_NEAR(day.light.sun.y, 3.47, 0.04 * 3.47);
    EXPECT_NEAR(day.light.sun.z, 2.86, 0.04 * 2.86);
    EXPECT_NEAR(luminance(shared::even_sky(day.light)), 0.59, 0.06 * 0.59);
}

TEST(Air, SkyIsUsableEverywhereAndSmoothOverItsRows) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const double elevation_deg : {-90.0, -4.0, 0.0, 3.0, 35.0, 90.0}) {
        const shared::Air air = clear_air().at(sun_at(elevation_deg)).air;
        for (int n = 0; n < 2000; ++n) {
            const vec3 way =
                glm::normalize(vec3(unit(random), unit(random), unit(random)) + vec3(1e-4f));
            EXPECT_TRUE(usable(shared::sky_radiance(air, way))) << n;
            const shared::AirLight seen = shared::haze_of(air, static_cast<float>(n) * 10 * way);
            EXPECT_TRUE(usable(seen.added) && usable(seen.through) && usable(1.0f - seen.through))
                << n;
        }
        EXPECT_TRUE(
            usable(shared::sky_radiance(air, vec3(0, 1.0000001f, 0)))); // a unit vector, rounded
        EXPECT_EQ(shared::haze_of(air, vec3(0)).through, vec3(1));
        EXPECT_EQ(shared::haze_of(air, vec3(0)).added, vec3(0));
    }
    const shared::Air air = clear_air().at(sun_at(20)).air;
    double before = 0, slope = 0;
    for (int n = 0; n < 900;
         ++n) { // across the rows, away from the sun: no step, and no step of the slope
        const double up = 0.1 * n * kDegree;
        const double here =
            luminance(shared::sky_radiance(air, vec3(0, std::sin(up), -std::cos(up))));
        if (n > 1) {
            EXPECT_LT(std::abs(here - before - slope), 4e-3) << n;
        }
        slope = n > 0 ? here - before : 0;
        before = here;
    }
}

TEST(Air, DistanceTakesContrastAsTheVisibilitySays) {
    for (const double visibility_km : {10.0, 60.0}) {
        const shared::Air air = render::Atmosphere(visibility_km).at(sun_at(35)).air;
        const float far_m = static_cast<float>(1000 * visibility_km);
        EXPECT_NEAR(shared::haze_of(air, vec3(0, 0, -far_m)).through.y, 0.02, 0.002);
        // A long level way ends in the horizon's light.
        const vec3 end = shared::haze_of(air, vec3(0, 0, -20 * far_m)).added,
                   sky = shared::sky_radiance(air, vec3(0, 0, -1));
        EXPECT_NEAR(luminance(end), luminance(sky), 0.12 * luminance(sky));
        // Blue is scattered most: far dark land is blue.
        const shared::AirLight seen = shared::haze_of(air, vec3(0, 0, -0.1f * far_m));
        EXPECT_TRUE(visibility_km < 20 || seen.through.x > seen.through.z);
    }
    // Upwards the air thins out, and from above it is thin from the start.
    const shared::Air air = clear_air().at(sun_at(35)).air;
    EXPECT_GT(shared::haze_of(air, vec3(0, 3000, -10000)).through.y,
              shared::haze_of(air, vec3(0, 0, -10440)).through.y);
    const shared::Air high = render::Atmosphere::thinned(air, 3000);
    const float down = shared::haze_of(high, vec3(0, -3000, -10000)).through.y,
                up = shared::haze_of(air, vec3(0, 3000, 10000)).through.y;
    EXPECT_NEAR(down, up, 1e-3); // the same way, whichever end one looks from
}

/// Land of 257 x 65 posts, 10 m apart, level but for a wall of one post's thickness from north to
/// south.
scene::Heightfield walled(int column, float height_m) {
    scene::Heightfield field{257, 65, {10, 10}, std::vector<float>(257 * 65, 100.0f), {}};
    for (int j = 0; j < field.height; ++j) {
        field.metres[static_cast<std::size_t>(j * field.width + column)] += height_m;
    }
    return field;
}

/// Metres from the wall's post, away from the sun along a row, at which half of the disc is seen.
double shadow_length(const SunSweep& sweep, int row, int column, int way, double post_m) {
    for (int n = 1; column + way * (n + 1) >= 0 && column + way * (n + 1) < sweep.width(); ++n) {
        const double here = shared::sun_share(sweep.seen_from(column + way * n, row), 0),
                     next = shared::sun_share(sweep.seen_from(column + way * (n + 1), row), 0);
        if (next > 0.5) {
            return post_m * (n + std::max(0.0, (0.5 - here) / (next - here)));
        }
    }
    return 1e9;
}

TEST(LandShadow, OfAWallIsAsLongAsTheSunsHeightMakesIt) {
    const scene::Heightfield field = walled(128, 50);
    SunSweep sweep(field);
    for (const double elevation_deg : {5.0, 10.0, 20.0, 35.0, 60.0}) {
        for (const double azimuth_deg : {90.0, 270.0, 60.0, 300.0}) {
            sweep.begin(sun_at(elevation_deg, azimuth_deg));
            ASSERT_TRUE(sweep.advance(1000));
            const double across =
                std::abs(std::sin(azimuth_deg * kDegree)); // the wall stands aslant to the sun
            const double expected = 50 / std::tan(elevation_deg * kDegree) * across;
            const int away = azimuth_deg < 180 ? -1 : 1;
            EXPECT_NEAR(shadow_length(sweep, 32, 128, away, 10), expected, 8 + 0.03 * expected)
                << elevation_deg << " from " << azimuth_deg;
            EXPECT_EQ(shared::sun_share(sweep.seen_from(128 - away, 32), 0),
                      1); // on the sunny side
        }
    }
}

TEST(LandShadow, ReachesToTheRimAndEndsWithHeight) {
    const scene::Heightfield field = walled(250, 100);
    SunSweep sweep(field);
    sweep.begin(sun_at(2.5, 90));
    ASSERT_TRUE(sweep.advance(1000));
    EXPECT_NEAR(shadow_length(sweep, 32, 250, -1, 10), 100 / std::tan(2.5 * kDegree), 60);
    // 1000 m behind the wall a point sees the middle of the sun from the height of the ray over the
    // wall.
    const vec2 seen = sweep.seen_from(150, 32);
    const double ray_m = 100 - 1000 * std::tan(2.5 * kDegree);
    EXPECT_EQ(shared::sun_share(seen, 0), 0);
    EXPECT_NEAR(shared::sun_share(seen, static_cast<float>(ray_m)), 0.5, 0.05);
    EXPECT_EQ(shared::sun_share(seen, static_cast<float>(ray_m + 1000 * std::tan(0.3 * kDegree))),
              1);
    sweep.begin(sun_at(0.1, 90)); // its lower rim is under the horizon
    ASSERT_TRUE(sweep.advance(1000));
    EXPECT_EQ(shared::sun_share(sweep.seen_from(0, 32), 0), 0);
}

TEST(LandShadow, LevelLandAndSunnySlopesHaveNone) {
    const scene::Heightfield flat = walled(0, 0);
    scene::Heightfield slope = flat;
    for (std::size_t n = 0; n < slope.metres.size(); ++n) {
        slope.metres[n] = -1.5f * static_cast<float>(n % 257); // down to the east by 8.5 degrees
    }
    SunSweep level(flat), falling(slope);
    for (const double elevation_deg : {0.0, 0.2, 3.0, 12.0, 89.9, 90.0}) {
        for (const double azimuth_deg : {0.0, 45.0, 90.0, 180.0, 271.0}) {
            level.begin(sun_at(elevation_deg, azimuth_deg));
            ASSERT_TRUE(level.advance(1000));
            falling.begin(sun_at(elevation_deg, azimuth_deg));
            ASSERT_TRUE(falling.advance(1000));
            for (int i = 0; i < 257; i += 16) {
                EXPECT_EQ(shared::sun_share(level.seen_from(i, 20), 0), 1)
                    << elevation_deg << " from " << azimuth_deg;
                const bool against = azimuth_deg == 271.0 && elevation_deg < 8 &&
                                     i > 0; // the slope itself hides a western sun
                EXPECT_EQ(shared::sun_share(falling.seen_from(i, 20), 0), against ? 0 : 1)
                    << elevation_deg << " from " << azimuth_deg << " at " << i;
            }
        }
    }
}

TEST(LandShadow, ComesToTheSameInPartsAsAtOnce) {
    const scene::Heightfield field = walled(128, 50);
    SunSweep whole(field), parts(field);
    whole.begin(sun_at(10, 120));
    ASSERT_TRUE(whole.advance(1000));
    parts.begin(sun_at(10, 120));
    int rounds = 1;
    while (!parts.advance(7)) {
        ++rounds;
    }
    EXPECT_GT(rounds, 30);
    EXPECT_EQ(whole.seen_from(), parts.seen_from());
}

} // namespace
} // namespace sward
