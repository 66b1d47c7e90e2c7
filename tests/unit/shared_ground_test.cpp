// SPDX-License-Identifier: Apache-2.0
// Ground and wind as pure functions: interpolation, relief, gusts.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shared/surface.h"
#include "shared/wind.h"
#include "terrain/surface.h"
#include "wind/wind.h"

namespace sward {
namespace {

using shared::vec2;
using shared::vec3;
using shared::vec4;

TEST(CatmullRom, PassesThroughPostsAndReproducesLines) {
    const vec4 p(3.0f, -1.0f, 7.5f, 2.0f);
    EXPECT_EQ(shared::catmull_rom(p, 0.0f), p.y);
    EXPECT_NEAR(shared::catmull_rom(p, 1.0f), p.z, 1e-5f);
    for (float t = 0.0f; t <= 1.0f; t += 0.05f) {
        EXPECT_NEAR(shared::catmull_rom(vec4(1, 3, 5, 7), t), 3 + 2 * t, 1e-5f);
        EXPECT_NEAR(shared::catmull_rom(vec4(4), t), 4, 1e-6f);
        // Quadratics too: central differences are exact on them.
        EXPECT_NEAR(shared::catmull_rom(vec4(1, 0, 1, 4), t), t * t, 1e-5f);
    }
}

TEST(CatmullRom, SlopeIsContinuousAtPosts) {
    const float posts[] = {2, 5, -1, 4, 4};
    const float e = 1e-3f;
    const vec4 left(posts[0], posts[1], posts[2], posts[3]),
        right(posts[1], posts[2], posts[3], posts[4]);
    const float before =
        (shared::catmull_rom(left, 1.0f) - shared::catmull_rom(left, 1.0f - e)) / e;
    const float after = (shared::catmull_rom(right, e) - shared::catmull_rom(right, 0.0f)) / e;
    EXPECT_NEAR(before, after, 0.05f);
}

TEST(Relief, IsContinuousAndBounded) {
    const float amplitude = 2.0f;
    float most = 0;
    for (const float z : {0.0f, -37.3f, 12345.6f}) {
        float before = shared::relief_at(vec2(-300.0f, z), amplitude, 0.5f);
        for (float x = -300.0f; x < 300.0f; x += 0.0625f) {
            const float here = shared::relief_at(vec2(x, z), amplitude, 0.5f);
            EXPECT_LT(std::abs(here - before), 0.06f) << x; // a slope below 1
            most = std::max(most, std::abs(here));
            before = here;
        }
    }
    EXPECT_GT(most, 0.2f * amplitude); // it is there
    EXPECT_LT(most, 1.3f * amplitude); // 0.71 (1 + 0.45 + ...), which Surface::range() relies on
    EXPECT_EQ(shared::relief_at(vec2(12.0f, 7.0f), 0.0f, 0.5f), 0.0f);
}

TEST(Relief, LeavesOutWhatAGridCannotHold) {
    const vec2 place(123.4f, -56.7f);
    EXPECT_EQ(shared::relief_at(place, 1.0f, 0.5f),
              shared::relief_at(place, 1.0f, 1.0f)); // 4 m is four posts of 1 m
    EXPECT_NE(shared::relief_at(place, 1.0f, 1.0f), shared::relief_at(place, 1.0f, 2.0f));
    EXPECT_NE(shared::relief_at(place, 1.0f, 16.0f), 0.0f);
    EXPECT_EQ(shared::relief_at(place, 1.0f, 16.1f), 0.0f);
}

TEST(GradientNoise, VanishesOnTheLatticeAndStaysWithinBounds) {
    for (int i = -5; i < 5; ++i) {
        EXPECT_EQ(shared::gradient_noise(vec2(i, 3 * i)), 0.0f);
    }
    for (float x = -20.0f; x < 20.0f; x += 0.173f) {
        EXPECT_LT(std::abs(shared::gradient_noise(vec2(x, 0.37f * x + 5))), 0.7072f);
    }
}

TEST(SlopeDensity, ThinsOutWithSlope) {
    const vec2 place(10.0f, 20.0f);
    const auto at = [&](float slope) {
        return shared::slope_density(glm::normalize(vec3(slope, 1, 0)), place);
    };
    EXPECT_EQ(at(0.0f), 1.0f);
    EXPECT_EQ(at(3.0f), 0.0f);
    EXPECT_EQ(shared::slope_density(vec3(1, 0, 0), place), 0.0f); // a wall: no division by zero
    for (float slope = 0.0f; slope < 2.0f; slope += 0.1f) {
        EXPECT_GE(at(slope), at(slope + 0.1f));
    }
}

scene::WindSpec gale(double speed, double gust) {
    scene::WindSpec spec;
    spec.speed_ms = speed;
    spec.gust = gust;
    return spec;
}

TEST(WindField, SpeedStaysWithinItsBounds) {
    for (const double gust : {0.0, 0.4, 1.0}) {
        const wind::Wind wind(gale(6, gust), 0.1);
        const shared::WindField field = wind.field({1000, -2000}, 33);
        float least = 1e9f, most = 0;
        for (float x = -400.0f; x < 400.0f; x += 3.1f) {
            for (float z = -400.0f; z < 400.0f; z += 37.0f) {
                const float speed = glm::length(shared::wind_field_at(field, vec2(x, z)));
                least = std::min(least, speed);
                most = std::max(most, speed);
            }
        }
        EXPECT_GE(least, 6 * (1 - 0.8 * gust) - 1e-4);
        EXPECT_LE(most, 6 * (1 + 1.6 * gust) + 1e-4);
        EXPECT_EQ(most - least > 0.5f, gust > 0) << "gusts move the speed, and only they";
    }
}

TEST(WindField, SameAnswerFromEveryAnchor) {
    const wind::Wind wind(gale(5, 0.7), 0.1);
    for (const double time : {0.0, 17.3, 3600.0}) {
        for (const glm::dvec2& place : {glm::dvec2(3, -8), glm::dvec2(-15000.25, 9876.5)}) {
            const glm::dvec2 truth = wind.at(place.x, place.y, time);
            for (const glm::dvec2& anchor :
                 {glm::dvec2(0), glm::dvec2(64, -128), glm::dvec2(-500, 700)}) {
                const glm::dvec2 base = glm::floor(place / 64.0) * 64.0 + anchor;
                const glm::dvec2 here(
                    shared::wind_field_at(wind.field(base, time), vec2(place - base)));
                EXPECT_LT(glm::length(here - truth), 1e-4 * glm::length(truth))
                    << time << " " << anchor.x;
            }
        }
    }
}

TEST(WindField, BlowsFromItsDirectionAndTravels) {
    scene::WindSpec spec = gale(5, 0);
    spec.direction_deg = 270; // from the west: towards +x
    const glm::dvec2 west = wind::Wind(spec, 0.1).at(10, 20, 5);
    EXPECT_NEAR(west.x, 5, 1e-4);
    EXPECT_NEAR(west.y, 0, 1e-4);
    spec.direction_deg = 0; // from the north: towards +z
    EXPECT_NEAR(wind::Wind(spec, 0.1).at(0, 0, 0).y, 5, 1e-4);
    const wind::Wind gusty(gale(5, 1), 0.1);
    EXPECT_GT(glm::length(gusty.at(0, 0, 0) - gusty.at(0, 0, 4)), 0.01);
}

TEST(WindField, CalmIsZeroNotNaN) {
    const wind::Wind wind(gale(0, 1), 0.1);
    const glm::dvec2 here = wind.at(12, 34, 56);
    EXPECT_EQ(here.x, 0);
    EXPECT_EQ(here.y, 0);
}

TEST(Surface, PassesThroughPostsAndHoldsItsRim) {
    scene::Heightfield field;
    field.width = 5;
    field.height = 4;
    field.spacing_m = {10, 20};
    for (int n = 0; n < 20; ++n) {
        field.metres.push_back(static_cast<float>((n * 7) % 11));
    }
    const terrain::Surface surface(field, 0);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 5; ++i) {
            EXPECT_NEAR(surface.height((i - 2) * 10, (j - 1.5) * 20),
                        field.metres[static_cast<std::size_t>(j * 5 + i)], 1e-4);
        }
    }
    EXPECT_EQ(surface.height(-1e6, -1e6), field.metres[0]);
    EXPECT_EQ(surface.height(1e6, 1e6), field.metres[19]);
    for (double x = -25; x < 25; x += 0.7) {
        for (double z = -35; z < 35; z += 1.3) {
            EXPECT_GE(surface.height(x, z), surface.range().x);
            EXPECT_LE(surface.height(x, z), surface.range().y);
        }
    }
}

} // namespace
} // namespace sward
