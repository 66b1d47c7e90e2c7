// SPDX-License-Identifier: Apache-2.0
// Hashes, codes and indices: the same bits wherever they are computed.
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "grass/set_files.h"
#include "shared/blade.h"
#include "shared/frame.h"
#include "shared/grass_layout.h"
#include "shared/hash.h"

namespace sward::shared {
namespace {

TEST(Hash, FixedValues) {
    // From an independent implementation of PCG-RXS-M-XS-32 over one LCG step.
    EXPECT_EQ(hash_pcg(0u), 0x07bb2fe2u);
    EXPECT_EQ(hash_pcg(1u), 0xa8beea3cu);
    EXPECT_EQ(hash_pcg(0xffffffffu), 0xe62a4902u);
    EXPECT_EQ(hash_pcg(12345u), 0xf45ead0eu);
    EXPECT_EQ(hash_ivec2(ivec2(1, 0), 0u), 0x703cc78au);
    EXPECT_EQ(hash_ivec2(ivec2(-1, -1), 0x5eedu), 0xf4eb50c3u);
    EXPECT_EQ(hash_ivec2(ivec2(1000, -2000), 0x7e11u), 0x69ebc578u);
}

TEST(Hash, UnitsAreUniform) {
    double sum = 0, squares = 0, products = 0;
    constexpr int kSide = 256, kCount = kSide * kSide;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float here = hash_to_unit(hash_ivec2(ivec2(x - 128, y - 128), 3u));
            const float right = hash_to_unit(hash_ivec2(ivec2(x - 127, y - 128), 3u));
            ASSERT_GE(here, 0.0f);
            ASSERT_LT(here, 1.0f);
            sum += here;
            squares += here * here;
            products += (here - 0.5) * (right - 0.5);
        }
    }
    const double mean = sum / kCount;
    EXPECT_NEAR(mean, 0.5, 5 * 0.289 / kSide); // five standard errors
    EXPECT_NEAR(squares / kCount - mean * mean, 1.0 / 12, 0.002);
    EXPECT_NEAR(products / kCount * 12, 0.0, 5.0 / kSide); // neighbours do not know each other
    EXPECT_LT(hash_to_unit(0xffffffffu), 1.0f);
    EXPECT_EQ(hash_to_unit(0u), 0.0f);
}

TEST(Hash, VariantsAreEvenAndIndependentOfTheirNeighbours) {
    for (const int variants : {1, 2, 3, 4, 7, 16}) {
        constexpr int kSide = 128;
        std::vector<int> count(static_cast<std::size_t>(variants));
        int same = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const int here = tile_variant(ivec2(x - 64, y - 64), variants);
                ASSERT_GE(here, 0);
                ASSERT_LT(here, variants);
                ++count[static_cast<std::size_t>(here)];
                same += here == tile_variant(ivec2(x - 63, y - 64), variants);
            }
        }
        constexpr double kTiles = kSide * kSide;
        const double share = 1.0 / variants,
                     error = 5 * std::sqrt(share * (1 - share) / kTiles) + 1e-9;
        for (const int n : count) {
            EXPECT_NEAR(n / kTiles, share, error) << variants << " variants";
        }
        EXPECT_NEAR(same / kTiles, share, error) << variants << " variants";
    }
}

TEST(Codes, RanksAndSeedsSurviveEightBits) {
    for (int n = 0; n < 256; ++n) {
        const float texel = static_cast<float>(n) / 255.0f; // what a sampler returns
        EXPECT_EQ(unorm8_to_unit(texel), (static_cast<float>(n) + 0.5f) / 256.0f) << n;
        // The driver may divide with an error of a few units in the last place.
        EXPECT_EQ(unorm8_to_unit(texel * (1 + 3e-7f)), (static_cast<float>(n) + 0.5f) / 256.0f)
            << n;
    }
}

TEST(Codes, TangentsAndOffsetsDecode) {
    EXPECT_LT(glm::length(decode_tangent(vec2(128 / 255.0f)) - vec3(0, 1, 0)), 0.01f);
    for (const vec2& code : {vec2(0.0f), vec2(1.0f), vec2(1.0f, 0.0f), vec2(0.8f, 0.4f)}) {
        const vec3 tangent = decode_tangent(code);
        EXPECT_TRUE(std::isfinite(tangent.y)); // outside the unit circle too
        EXPECT_GE(tangent.y, 0.0f);
    }
    EXPECT_NEAR(glm::length(decode_tangent(vec2(0.8f, 0.4f))), 1.0f, 1e-6f);
    EXPECT_EQ(decode_offset(vec2(0.0f, 1.0f), 0.3f), vec2(-0.3f, 0.3f));
}

TEST(Layout, ImageIndicesAreAllDifferentAndDense) {
    constexpr int kVariants = 3, kCount = 5;
    std::set<int> layers, slices;
    for (int variant = 0; variant < kVariants; ++variant) {
        for (int i = 0; i < kCount; ++i) {
            for (int plane = 0; plane < kPlanes; ++plane) {
                layers.insert(layer_index(variant, i, kCount, plane));
                slices.insert(slice_index(variant, kAxisX, i, kCount, plane));
                slices.insert(slice_index(variant, kAxisZ, i, kCount, plane));
            }
        }
    }
    EXPECT_EQ(layers.size(), std::size_t{kVariants * kCount * kPlanes});
    EXPECT_EQ(*layers.rbegin(), kVariants * kCount * kPlanes - 1);
    EXPECT_EQ(slices.size(), std::size_t{2 * kVariants * kCount * kPlanes});
    EXPECT_EQ(*slices.rbegin(), 2 * kVariants * kCount * kPlanes - 1);
    EXPECT_EQ(layer_index(1, 2, kCount, kPlaneShape),
              layer_index(1, 2, kCount, kPlaneId) + kPlaneShape);
}

TEST(Layout, AReadableSetFitsTheRenderersLevels) {
    EXPECT_LE(grass::kMaxFarLevels, kMaxFarLevels); // bands, lists and constants hold this many
}

} // namespace
} // namespace sward::shared
