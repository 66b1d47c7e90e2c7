// SPDX-License-Identifier: Apache-2.0
// The hand-over: each blade is drawn by exactly one tier, whatever its rank, distance and pixel.
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "lod/lod.h"
#include "shared/blade.h"
#include "shared/lod.h"

namespace sward::shared {
namespace {

constexpr int kModes[] = {kHandoverRank, kHandoverOff, kHandoverHard, kHandoverFade};

std::vector<float> ranks() {
    std::vector<float> all;
    for (int n = 0; n < 256; n += 3) {
        all.push_back((static_cast<float>(n) + 0.5f) / 256);
    }
    return all;
}

std::vector<float> dithers() {
    std::vector<float> all;
    for (int n = 0; n < 16; ++n) {
        all.push_back((static_cast<float>(n) + 0.5f) / 16);
    }
    return all;
}

TEST(Handover, ShareFallsSmoothlyFromOneToZero) {
    const vec2 band(5.0f, 11.0f);
    EXPECT_EQ(handover_share(0.0f, band), 1.0f);
    EXPECT_EQ(handover_share(5.0f, band), 1.0f);
    EXPECT_EQ(handover_share(11.0f, band), 0.0f);
    EXPECT_EQ(handover_share(1e6f, band), 0.0f);
    EXPECT_NEAR(handover_share(8.0f, band), 0.5f, 1e-6f);
    float before = 1.0f;
    for (float d = 4.5f; d < 11.5f; d += 0.01f) {
        const float here = handover_share(d, band);
        EXPECT_LE(here, before);
        EXPECT_LT(before - here, 0.01f); // no jump
        before = here;
    }
    // A band without width is a hard step, not a NaN.
    EXPECT_EQ(handover_share(6.9f, vec2(7.0f, 7.0f)), 1.0f);
    EXPECT_EQ(handover_share(7.1f, vec2(7.0f, 7.0f)), 0.0f);
}

TEST(Handover, DistanceInvertsShare) {
    const vec2 band(3.0f, 9.0f);
    for (float share = 0.0f; share <= 1.0f; share += 0.01f) {
        const float d = handover_distance(share, band);
        EXPECT_GE(d, band.x - 1e-4f);
        EXPECT_LE(d, band.y + 1e-4f);
        EXPECT_NEAR(handover_share(d, band), share, 2e-5f);
    }
    EXPECT_NEAR(handover_distance(2.0f, band), band.x, 1e-3f); // clamped
    EXPECT_NEAR(handover_distance(-1.0f, band), band.y, 1e-3f);
}

/// Tiers that draw a pixel of a blade: the near one as cull.comp and blade.frag decide, the far
/// ones as far.frag does, and the ground by the last level's outgoing band.
int tiers_that_draw(const lod::Bands& bands, int levels, float rank, float distance, float dither,
                    int mode) {
    const vec2 handover(bands.handover);
    int count = handover_may_be_near(rank, distance, handover, mode) &&
                (mode == kHandoverOff || handover_near(rank, distance, handover, dither, mode));
    for (int k = 0; k < levels; ++k) {
        const vec4 band = bands.far[static_cast<std::size_t>(k)];
        const vec2 incoming(band.x, band.y), outgoing(band.z, band.w);
        const bool near = k > 0 ? handover_near(rank, distance, incoming, dither, kHandoverRank)
                          : mode == kHandoverOff
                              ? distance < band.x
                              : handover_near(rank, distance, incoming, dither, mode);
        count += !near && handover_near(rank, distance, outgoing, dither, kHandoverRank);
    }
    const vec4 last = bands.far[static_cast<std::size_t>(levels - 1)];
    return count + !handover_near(rank, distance, vec2(last.z, last.w), dither, kHandoverRank);
}

TEST(Handover, ExactlyOneTierDrawsABlade) {
    constexpr int kLevels = 4;
    const lod::Bands bands = lod::bands({}, {900, 0.006, 0.004, kLevels}, {});
    for (const int mode : {kHandoverRank, kHandoverHard, kHandoverFade}) {
        for (float d = 0.3f; d < 1.1f * bands.far[kLevels - 1].w; d *= 1.05f) {
            for (const float rank : ranks()) {
                for (const float dither : dithers()) {
                    ASSERT_EQ(tiers_that_draw(bands, kLevels, rank, d, dither, mode), 1)
                        << "mode " << mode << " distance " << d << " rank " << rank << " dither "
                        << dither;
                }
            }
        }
    }
}

TEST(Handover, OffDrawsBothTiersWholeInTheBandOnly) {
    const lod::Bands bands = lod::bands({}, {900, 0.006, 0.004, 2}, {});
    const float start = bands.handover.x, end = bands.handover.y;
    for (const float rank : ranks()) {
        EXPECT_EQ(tiers_that_draw(bands, 2, rank, 0.9f * start, 0.4f, kHandoverOff), 1);
        EXPECT_EQ(tiers_that_draw(bands, 2, rank, 0.5f * (start + end), 0.4f, kHandoverOff), 2);
        EXPECT_EQ(tiers_that_draw(bands, 2, rank, 1.02f * end, 0.4f, kHandoverOff), 1);
    }
}

TEST(Handover, CullingNeverDropsANearPixel) {
    const vec2 band(4.0f, 10.0f);
    for (const int mode : kModes) {
        for (const float rank : ranks()) {
            bool before = true;
            for (float d = 3.0f; d < 11.0f; d += 0.05f) {
                const bool may = handover_may_be_near(rank, d, band, mode);
                EXPECT_TRUE(before || !may) << "near again at " << d;
                before = may;
                for (const float dither : dithers()) {
                    if (mode != kHandoverOff && handover_near(rank, d, band, dither, mode)) {
                        EXPECT_TRUE(may)
                            << "mode " << mode << " rank " << rank << " distance " << d;
                    }
                }
            }
        }
    }
}

TEST(Handover, WholeOutsideTheBandWhateverTheRank) {
    const vec2 band(4.0f, 10.0f);
    for (const int mode : {kHandoverRank, kHandoverHard, kHandoverFade}) {
        for (const float dither : dithers()) {
            for (const float rank : {0.0f, 0.5f / 256, 0.5f, 255.5f / 256, 0.99999f}) {
                EXPECT_TRUE(handover_near(rank, 4.0f, band, dither, mode));
                EXPECT_FALSE(handover_near(rank, 10.0f, band, dither, mode));
            }
        }
    }
}

TEST(Handover, ShareOfNearPixelsIsTheShare) {
    const vec2 band(4.0f, 10.0f);
    for (const int mode : {kHandoverRank, kHandoverFade}) {
        for (float d = 4.0f; d <= 10.0f; d += 0.5f) {
            double near = 0, all = 0;
            for (int n = 0; n < 256; ++n) {
                for (const float dither : dithers()) {
                    near +=
                        handover_near((static_cast<float>(n) + 0.5f) / 256, d, band, dither, mode);
                    all += 1;
                }
            }
            EXPECT_NEAR(near / all, handover_share(d, band), 0.04)
                << "mode " << mode << " at " << d;
        }
    }
}

TEST(Handover, ModesIgnoreWhatTheirNamesSay) {
    const vec2 band(4.0f, 10.0f);
    for (float d = 4.2f; d < 10.0f; d += 0.4f) {
        const bool hard = handover_near(0.5f, d, band, 0.5f, kHandoverHard);
        EXPECT_EQ(hard, d < 7.0f);
        for (const float rank : ranks()) {
            for (const float dither : dithers()) {
                EXPECT_EQ(handover_near(rank, d, band, dither, kHandoverHard), hard);
                EXPECT_EQ(handover_near(rank, d, band, dither, kHandoverFade),
                          dither < handover_share(d, band));
            }
        }
    }
    // By rank: at mid band low ranks are geometry, high ones shells, and the dither decides between
    // only.
    EXPECT_TRUE(handover_near(0.4f, 7.0f, band, 0.97f, kHandoverRank));
    EXPECT_FALSE(handover_near(0.6f, 7.0f, band, 0.03f, kHandoverRank));
    EXPECT_TRUE(handover_near(0.5f, 7.0f, band, 0.03f, kHandoverRank));
    EXPECT_FALSE(handover_near(0.5f, 7.0f, band, 0.97f, kHandoverRank));
}

TEST(Handover, PoseIsTheShellsBeforeAnyPixelIsFar) {
    for (const vec2& band :
         {vec2(4.0f, 10.0f), vec2(2.0f, 2.2f), vec2(0.5f, 60.0f), vec2(0.0f, 10.0f)}) {
        for (const float rank : ranks()) {
            float before = 0.0f;
            for (float d = 0.02f; d < 1.1f * band.y; d *= 1.01f) {
                const float pose = pose_share(rank, d, band);
                EXPECT_GE(pose, before);
                before = pose;
                if (!handover_near(rank, d, band, 1.0f, kHandoverRank)) { // the most eager pixel
                    EXPECT_EQ(pose, 1.0f) << "rank " << rank << " at " << d;
                }
            }
            EXPECT_EQ(pose_share(rank, 0.0f, band),
                      0.0f); // a scene may start the band at 0: no NaN there
        }
    }
}

TEST(Handover, PixelThresholdsAreAPermutation) {
    std::set<float> seen;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            const float threshold = pixel_threshold(ivec2(x, y));
            seen.insert(threshold);
            EXPECT_EQ(threshold, pixel_threshold(ivec2(x + 4, y + 8)));
            const float n = threshold * 16 - 0.5f;
            EXPECT_EQ(n, std::floor(n));
        }
    }
    EXPECT_EQ(seen.size(), 16u);
    EXPECT_EQ(*seen.begin(), 0.5f / 16);
    EXPECT_EQ(*seen.rbegin(), 15.5f / 16);
    // Bayer's order: every 2 x 2 block holds one threshold of each quarter.
    for (int y = 0; y < 4; y += 2) {
        for (int x = 0; x < 4; x += 2) {
            std::set<int> quarters;
            for (int i = 0; i < 4; ++i) {
                quarters.insert(static_cast<int>(4 * pixel_threshold(ivec2(x + i % 2, y + i / 2))));
            }
            EXPECT_EQ(quarters.size(), 4u);
        }
    }
}

TEST(Slices, BothFamiliesTogetherShowWhatABladeHas) {
    for (const float density : {1.0f, 0.5f, 0.1f}) {
        for (float azimuth = 0.0f; azimuth < 6.28f; azimuth += 0.1f) {
            const vec2 view(std::cos(azimuth), std::sin(azimuth));
            double seen = 0, standing = 0;
            constexpr int kSeeds = 4096;
            for (int n = 0; n < kSeeds; ++n) {
                const float seed = (static_cast<float>(n) + 0.5f) / kSeeds;
                standing += seed < density;
                // Each family is foreshortened by its component once more.
                for (const float component : {view.x, view.y}) {
                    if (slice_shows(seed, density, component)) {
                        EXPECT_LT(seed, density); // never a blade that the density took away
                        seen += std::abs(component);
                    }
                }
            }
            EXPECT_NEAR(seen / standing, 1.0, 0.01)
                << "azimuth " << azimuth << " density " << density;
        }
    }
    EXPECT_FALSE(slice_shows(0.5f / 256, 0.0f, 1.0f));
    EXPECT_FALSE(slice_shows(0.5f / 256, 1.0f, 0.0f));
}

TEST(Shells, ShowTheirShareFromTheSeedsThatSlicesUseLast) {
    for (const float density : {1.0f, 0.4f}) {
        for (const float share : {0.0f, 0.25f, 0.7f, 1.0f}) {
            double shown = 0, standing = 0, both = 0;
            for (int n = 0; n < 4096; ++n) {
                const float seed = (static_cast<float>(n) + 0.5f) / 4096;
                if (seed >= density) {
                    continue; // far.frag's first test
                }
                standing += 1;
                shown += shell_shows(seed, density, share);
                both += shell_shows(seed, density, share) && slice_shows(seed, density, 1 - share);
            }
            EXPECT_NEAR(shown / standing, share, 1e-3) << density;
            EXPECT_EQ(both, 0.0);
        }
    }
}

} // namespace
} // namespace sward::shared
