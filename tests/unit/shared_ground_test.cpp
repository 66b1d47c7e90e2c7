// SPDX-License-Identifier: Apache-2.0
// Ground as pure functions: interpolation, relief.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shared/surface.h"
#include "terrain/surface.h"

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
