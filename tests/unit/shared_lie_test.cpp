// SPDX-License-Identifier: Apache-2.0
// How the patch lies on its tiles: shader functions of shaders/shared/tile_lie.h, compiled as C++.
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "shared/tile_lie.h"

namespace sward::shared {
namespace {

constexpr float kSide = 2;

vec3 front_of(const BladeRecord& blade, float v) {
    const vec3 v1(blade.v1), v2(blade.v2);
    return glm::normalize(
        glm::cross(blade_tangent(v1, v2, v), blade_width_direction(blade.shape.x)));
}

BladeRecord some_blade() {
    BladeRecord blade{};
    blade.root = vec4(1.9f, 0.3f, 0.4f, 0.7f);
    blade.v1 = vec4(0.03f, 0.1f, -0.02f, 0.004f);
    blade.v2 = vec4(0.12f, 0.25f, -0.05f, 0.6f);
    blade.shape = vec4(1.1f, 0.3f, 0.2f, 2);
    return blade;
}

TEST(TileLie, SourceIsThePlaceBackwards) {
    for (uint lie = 0; lie < 512; ++lie) {
        for (const vec2 place : {vec2(0.03f, 0.97f), vec2(0.5f, 0.25f), vec2(0.71f, 0.33f)}) {
            const vec2 back = glm::fract(lie_source(lie, lie_place(lie, place)) + 1e-6f);
            EXPECT_LT(glm::length(back - place), 1e-5f) << lie;
        }
    }
}

TEST(TileLie, ABladeIsMirroredAndTurnedAsAWhole) {
    const BladeRecord blade = some_blade();
    for (uint lie = 0; lie < 512; ++lie) {
        const BladeRecord laid = lay_blade(lie, blade, kSide);
        const vec3 front = front_of(blade, 0.4f), turned = front_of(laid, 0.4f);
        EXPECT_LT(glm::length(vec2(turned.x, turned.z) - lie_along(lie, vec2(front.x, front.z))),
                  1e-5f)
            << lie;
        EXPECT_NEAR(turned.y, front.y, 1e-5f) << lie; // its upper side stays above
        EXPECT_NEAR(glm::length(vec3(laid.v2)), glm::length(vec3(blade.v2)), 1e-6f);
        EXPECT_EQ(laid.v2.y, blade.v2.y);
        EXPECT_EQ(laid.root.z, blade.root.z); // rank and seed: it stays the blade that it is
        EXPECT_EQ(laid.root.w, blade.root.w);
        EXPECT_TRUE(laid.root.x >= 0 && laid.root.x <= kSide && laid.root.y >= 0 &&
                    laid.root.y <= kSide)
            << lie;
    }
    const BladeRecord same = lay_blade(kLieAsGrown, blade, kSide);
    EXPECT_NEAR(same.root.x, blade.root.x, 1e-6f);
    EXPECT_EQ(same.shape.x, blade.shape.x);
}

TEST(TileLie, ItsTextureShowsTheBladeWhereItStands) {
    const BladeRecord blade = some_blade();
    for (uint lie = 0; lie < 512; ++lie) {
        const BladeRecord laid = lay_blade(lie, blade, kSide);
        const vec2 read = glm::fract(lie_source(lie, vec2(laid.root) / kSide) + 1e-6f) * kSide;
        EXPECT_LT(glm::length(read - vec2(blade.root)), 1e-5f) << lie;
    }
}

// Power of a row of tiles at the n-th harmonic of the patch's period over that of a plain row of as
// many strangers.
double harmonic(int n, bool laid) {
    constexpr int kTiles = 48, kPoints = 40;
    std::vector<vec2> points;
    for (int i = 0; i < kPoints; ++i) {
        points.emplace_back(hash_to_unit(hash_ivec2({i, 1}, 7)),
                            hash_to_unit(hash_ivec2({i, 2}, 7)));
    }
    std::complex<double> sum = 0;
    for (int z = 0; z < kTiles; ++z) {
        for (int x = 0; x < kTiles; ++x) {
            for (const vec2 point : points) {
                const double at = lie_place(laid ? tile_lie({x, z}) : kLieAsGrown, point).x;
                sum += std::polar(1.0, 2 * std::numbers::pi * n * at);
            }
        }
    }
    return std::norm(sum) / (static_cast<double>(kTiles) * kTiles * kPoints);
}

TEST(TileLie, ThePatchHasNoPeriodInTheMeanOfItsTiles) {
    double plain = 0, laid = 0;
    for (int n = 1; n < kLieShifts; ++n) {
        plain += harmonic(n, false) / (kLieShifts - 1);
        laid += harmonic(n, true) / (kLieShifts - 1);
    }
    EXPECT_GT(plain, 200); // 2304 tiles in step
    EXPECT_LT(laid, 3);    // strangers: 1, give or take 1 for each
}

TEST(TileLie, TilesDifferFromTheirNeighbours) {
    constexpr int kTiles = 128;
    std::vector<int> count(512);
    int same = 0;
    for (int z = 0; z < kTiles; ++z) {
        for (int x = 0; x < kTiles; ++x) {
            const uint lie = tile_lie({x - 64, z - 64});
            ++count[lie];
            same += lie == tile_lie({x - 63, z - 64}) ? 1 : 0;
        }
    }
    for (const int n : count) {
        EXPECT_NEAR(n, 32, 5.5 * std::sqrt(32.0));
    }
    EXPECT_NEAR(same, 32, 5.5 * std::sqrt(32.0));
}

} // namespace
} // namespace sward::shared
