// SPDX-License-Identifier: Apache-2.0
// Blades of meshes as shapes: the outlines against J8's printed forms, teeth that survive every
// level, the width correction, where a blade comes to rest.
#include <cmath>

#include <gtest/gtest.h>

#include "shared/blade.h"
#include "shared/surface_blade.h"

namespace sward::shared {
namespace {

vec4 shape_of(int kind, float tau = 0.7f, float teeth = 5, float depth = 0.6f) {
    return {static_cast<float>(kind), tau, teeth, depth};
}

TEST(SurfaceShape, OutlinesHaveThePrintedWidths) {
    const float tau = 0.7f;
    for (int i = 0; i <= 20; ++i) {
        const float v = static_cast<float>(i) / 20;
        const auto printed_width = [&](auto t) { return t(1.0f) - t(0.0f); };
        EXPECT_NEAR(surface_blade_width(v, shape_of(kShapeQuad), 8),
                    printed_width([](float u) { return u; }), 1e-6);
        EXPECT_NEAR(surface_blade_width(v, shape_of(kShapeTriangle), 8),
                    printed_width([&](float u) { return u + v / 2 - u * v; }), 1e-6);
        EXPECT_NEAR(surface_blade_width(v, shape_of(kShapeQuadratic), 8),
                    printed_width([&](float u) { return u - u * v * v; }), 1e-6);
        const auto tip = [&](float u) {
            return 0.5f + (u - 0.5f) * (1 - std::max(v - tau, 0.0f) / (1 - tau));
        };
        EXPECT_NEAR(surface_blade_width(v, shape_of(kShapeTriangleTip, tau), 8), printed_width(tip),
                    1e-6);
        for (const float u : {0.0f, 0.3f, 1.0f}) { // these two agree in place too
            EXPECT_NEAR(surface_blade_outline(u, v, shape_of(kShapeTriangle), {8, 0}),
                        u + v / 2 - u * v, 1e-6);
            EXPECT_NEAR(surface_blade_outline(u, v, shape_of(kShapeTriangleTip, tau), {8, 0}),
                        tip(u), 1e-6);
        }
    }
}

TEST(SurfaceShape, WidthCorrectionNeverDragsABladeAside) {
    for (int kind = kShapeQuad; kind <= kShapeDandelion; ++kind) {
        for (const float phi : {0.0f, 0.5f, 1.0f}) {
            for (int i = 0; i <= 10; ++i) {
                const float v = static_cast<float>(i) / 10;
                EXPECT_NEAR(surface_blade_outline(0.5f, v, shape_of(kind), {10, phi}), 0.5f, 1e-6);
                const float left = surface_blade_outline(0, v, shape_of(kind), {10, phi}),
                            right = surface_blade_outline(1, v, shape_of(kind), {10, phi});
                EXPECT_NEAR(left + right, 1, 1e-6);
                EXPECT_GE(right - left,
                          surface_blade_width(v, shape_of(kind), 10) - 1e-6f); // it only widens
            }
        }
        EXPECT_EQ(surface_blade_outline(1, 1, shape_of(kind), {10, 1}), 1); // as a quad in the end
    }
    // The printed mixing, t (1 - phi) + u phi^2, moves the middle.
    const float phi = 0.5f;
    EXPECT_LT(0.5f * (1 - phi) + 0.5f * phi * phi, 0.4f);
}

/// Greatest widths between lesser ones at the stations of a level, and the mean width between them.
std::pair<int, double> teeth_and_mean(vec4 shape, float level) {
    int points = 0;
    double mean = 0;
    float before = 0, last = 0, last_v = 0;
    for (int i = 0; i <= static_cast<int>(level); ++i) {
        const float v = surface_blade_station(static_cast<float>(i) / level, shape, level);
        const float width = surface_blade_width(v, shape, level);
        if (i > 1 && last > before && last > width) {
            ++points;
        }
        mean += i > 0 ? 0.5 * (last + width) * (v - last_v) : 0;
        before = last;
        last = width;
        last_v = v;
    }
    return {points, mean};
}

TEST(SurfaceShape, DandelionTeethSurviveEveryLevel) {
    const vec4 leaf = shape_of(kShapeDandelion);
    const double whole = teeth_and_mean(leaf, 200).second;
    for (int wanted = 1; wanted <= 24; ++wanted) {
        const float level = surface_blade_level(static_cast<float>(wanted), 24, leaf);
        EXPECT_EQ(std::fmod(level, 2), 0);
        EXPECT_LE(level, std::max(wanted, 2));
        EXPECT_GT(level, 0.45f * static_cast<float>(wanted));
        const auto [points, mean] = teeth_and_mean(leaf, level);
        EXPECT_EQ(points, std::clamp(wanted / 2, 1, 5)) << wanted;
        EXPECT_NEAR(mean, whole, 0.2 * whole) << wanted; // a single tooth is the coarsest
    }
    // An outline that does not know the level loses them: at 4 segments the five teeth's own
    // outline, sampled evenly.
    int points = 0;
    for (int i = 1; i < 4; ++i) {
        const auto w = [&](int k) {
            return surface_blade_width(static_cast<float>(k) / 4, leaf, 10);
        };
        points += w(i) > w(i - 1) && w(i) > w(i + 1);
    }
    EXPECT_LT(points, 2);
}

TEST(SurfaceShape, StationsStandOnTheKinks) {
    const vec4 tip = shape_of(kShapeTriangleTip, 0.8f);
    for (int wanted = 1; wanted <= 24; ++wanted) {
        const float level = surface_blade_level(static_cast<float>(wanted), 24, tip);
        bool met = false;
        for (int i = 0; i <= static_cast<int>(level); ++i) {
            met = met || std::abs(surface_blade_station(static_cast<float>(i) / level, tip, level) -
                                  0.8f) < 1e-6f;
        }
        EXPECT_TRUE(met) << wanted;
    }
    for (int kind = kShapeQuad; kind <= kShapeDandelion; ++kind) {
        float before = -1;
        for (int i = 0; i <= 10; ++i) {
            const float v = surface_blade_station(static_cast<float>(i) / 10, shape_of(kind), 10);
            EXPECT_GT(v, before);
            before = v;
        }
        EXPECT_EQ(surface_blade_station(0, shape_of(kind), 10), 0);
        EXPECT_EQ(surface_blade_station(1, shape_of(kind), 10), 1);
    }
}

TEST(SurfaceBladeRest, WidthDirectionsAreSquareToUp) {
    for (int i = 0; i < 500; ++i) {
        const auto n = static_cast<uint>(i);
        const float y = 2 * hash_to_unit(hash_pcg(n)) - 1,
                    a = 6.2831853f * hash_to_unit(hash_pcg(n + 7777)),
                    turn = 0.1f * static_cast<float>(i);
        const vec3 up(std::sqrt(1 - y * y) * std::cos(a), y, std::sqrt(1 - y * y) * std::sin(a));
        const vec3 across = surface_width_direction(up, turn);
        EXPECT_NEAR(length(across), 1, 1e-5);
        EXPECT_NEAR(dot(across, up), 0, 1e-5);
    }
    const vec3 level = surface_width_direction({0, 1, 0}, 0.7f), set = blade_width_direction(0.7f);
    EXPECT_NEAR(length(level - set), 0, 1e-6);
    EXPECT_NEAR(surface_width_direction({0, -1, 0}, 0.7f).y, 0, 1e-6); // no pole where it fails
}

float curve_length_of(vec3 v1, vec3 v2) {
    float sum = 0;
    for (int i = 0; i < 256; ++i) {
        sum += length(blade_curve(v1, v2, static_cast<float>(i + 1) / 256) -
                      blade_curve(v1, v2, static_cast<float>(i) / 256));
    }
    return sum;
}

TEST(SurfaceBladeRest, RestIsWhereRecoveryAndGravityBalance) {
    const float height = 0.3f;
    for (const vec3 up : {vec3(0, 1, 0), vec3(0.8f, 0.6f, 0), vec3(0, -1, 0), vec3(0, 0, 1)}) {
        vec3 v1, v2;
        surface_settle(v1, v2, up, height, vec3(0));
        EXPECT_NEAR(length(v2 - height * up), 0, 1e-6); // J1's pose without gravity
        const vec3 pull = surface_gravity(up, surface_width_direction(up, 1), 0.4f * height);
        surface_settle(v1, v2, up, height, pull);
        EXPECT_GE(dot(v2, up), -1e-6f); // no tip under the surface
        EXPECT_NEAR(curve_length_of(v1, v2), height, 0.01f * height);
        // One more of J4's steps with J5 moves it by little: that is what balance means.
        vec3 next1, next2 = v2 + 0.5f * (height * up + pull - v2);
        next1 = settle_blade(upright_body(up, height), next2);
        EXPECT_LT(length(next2 - v2), 0.01f * height);
        if (up.y < 0.9f && up.y > -0.9f) {
            EXPECT_LT(v2.y, (height * up).y - 0.05f * height); // it hangs
        }
    }
}

TEST(SurfaceBladeRest, RanksAndSeedsAreEvenAndExact) {
    double rank = 0, seed = 0, product = 0;
    constexpr int kCount = 20000;
    for (uint i = 0; i < kCount; ++i) {
        const vec2 own = surface_rank_seed(i);
        EXPECT_EQ(own.x * 256 - 0.5f, std::floor(own.x * 256));
        rank += own.x / kCount;
        seed += own.y / kCount;
        product += own.x * own.y / kCount;
    }
    EXPECT_NEAR(rank, 0.5, 0.01);
    EXPECT_NEAR(seed, 0.5, 0.01);
    EXPECT_NEAR(product, 0.25, 0.01);
}

} // namespace
} // namespace sward::shared
