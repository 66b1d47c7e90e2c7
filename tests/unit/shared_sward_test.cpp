// SPDX-License-Identifier: Apache-2.0
// Patches of the sward and the floor under it: shader functions of shaders/shared/sward.h, compiled
// as C++.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shared/sward.h"

namespace sward::shared {
namespace {

constexpr ivec2 kAnchor(3, -7);
constexpr int kSide = 400; // points a side of a square

template<class At> double mean_over(float metres, At at) {
    double sum = 0;
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            // Places of no lattice: an additive recurrence along each row
            const double a = std::fmod(0.7548776662466927 * (i + kSide * j), 1.0),
                         b = std::fmod(0.5698402909980532 * (i + kSide * j), 1.0);
            sum += at(vec2(a, b) * metres);
        }
    }
    return sum / (kSide * kSide);
}

TEST(Sward, APlaceHasItsOwnPatchWhereverTheAnchorIs) {
    for (const float width : {0.001f, 0.3f, 5.0f}) {
        for (const vec2 place : {vec2(0.3f, 0.7f), vec2(17.25f, -40.5f), vec2(63.0f, 1.5f)}) {
            const float here = sward_patches(place, kAnchor, 0.5f, width);
            EXPECT_NEAR(sward_patches(place + vec2(64, -128), kAnchor - ivec2(1, -2), 0.5f, width),
                        here, 1e-5f);
            const vec3 floor_here = floor_at(place, kAnchor, vec2(0.6f, 0.5f), width);
            EXPECT_LT(glm::length(floor_at(place + vec2(64, -128), kAnchor - ivec2(1, -2),
                                           vec2(0.6f, 0.5f), width) -
                                  floor_here),
                      2e-2f);
        }
    }
    // A thousand kilometres from the origin it is as fine as there.
    const ivec2 away(15625, 15625);
    EXPECT_NE(sward_patches(vec2(0.5f, 0.5f), away, 0.5f, 0.01f),
              sward_patches(vec2(0.9f, 0.5f), away, 0.5f, 0.01f));
}

TEST(Sward, TheMeanStaysThatOfThePreset) {
    EXPECT_NEAR(mean_over(1000, [](vec2 at) { return sward_patches(at, kAnchor, 0.5f, 0.01f); }),
                0.5, 0.01);
    EXPECT_EQ(sward_patches(vec2(3, 4), kAnchor, 0.5f, 100),
              0.5f); // all that a pixel of 100 m shows
}

TEST(Sward, WiderPixelsShowLess) {
    double before = 1;
    for (const float width : {0.05f, 1.0f, 4.0f, 16.0f}) {
        const double variance = mean_over(500, [&](vec2 at) {
            const double off = sward_patches(at, kAnchor, 0.5f, width) - 0.5;
            return off * off;
        });
        EXPECT_LT(variance, 0.95 * before) << width;
        before = variance;
    }
    EXPECT_LT(std::sqrt(before), 0.08);
}

TEST(Sward, FloorCoversWhatItIsToldAtEveryWidth) {
    for (const float cover : {0.15f, 0.5f, 0.72f, 0.9f}) {
        for (const float width : {0.001f, 0.02f, 0.2f, 3.0f}) {
            const vec2 told(cover, 0.5f);
            const double share =
                mean_over(40, [&](vec2 at) { return floor_at(at, kAnchor, told, width).y; });
            EXPECT_NEAR(share, cover, 0.06) << cover << " at " << width << " m";
            const double light =
                mean_over(40, [&](vec2 at) { return floor_at(at, kAnchor, told, width).x; });
            EXPECT_NEAR(light, 1 + 0.5 * kStalkShare, 0.04) << cover << " at " << width << " m";
        }
    }
}

TEST(Sward, StalksCoverTheirShare) {
    EXPECT_NEAR(mean_over(8, [](vec2 at) { return stalks_at(at, kAnchor, 0.001f); }), kStalkShare,
                0.02);
    EXPECT_EQ(stalks_at(vec2(1, 1), kAnchor, 1), kStalkShare);
}

} // namespace
} // namespace sward::shared
