// SPDX-License-Identifier: Apache-2.0
// The hand-over: which tier shows a blade. One function, called by the blade culling and by every
// shell and slice fragment, so that each blade is drawn by exactly one tier.
#ifndef SWARD_SHARED_LOD_H
#define SWARD_SHARED_LOD_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kMaxFarLevels = 4;
SHARED_CONST int kHandoverRank = 0; // ships: blade by blade, by rank
SHARED_CONST int kHandoverOff = 1;  // tests: both tiers whole in the band
SHARED_CONST int kHandoverHard = 2; // tests: all at one distance
SHARED_CONST int kHandoverFade = 3; // tests: every blade by the same pixel dither

// Share of rank over which a single blade's swap is dithered, pixel by pixel. Wider is softer and
// costs double fragments for that share of the band's blades.
SHARED_CONST float kSwapWidth = 0.06f;

// g(d): share of the blades that are still on the near side of a band (start, end) at distance d;
// smooth, 1 to 0.
SHARED_FN float handover_share(float distance_m, vec2 band) {
    float t = clamp((distance_m - band.x) / max(band.y - band.x, 1e-6f), 0.0f, 1.0f);
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

// True on the near side of the band. `dither` in (0, 1) is the pixel's threshold: with the same
// one, near and far are exact complements, and at share 1 (0) every (no) blade is near whatever its
// rank.
SHARED_FN bool handover_near(float rank, float distance_m, vec2 band, float dither, int mode) {
    float share = handover_share(distance_m, band);
    if (mode == kHandoverHard) {
        return share > 0.5f;
    }
    if (mode == kHandoverFade) {
        return dither < share;
    }
    return rank + (dither - 0.5f) * kSwapWidth <
           mix(-0.5f * kSwapWidth, 1.0f + 0.5f * kSwapWidth, share);
}

// Could any pixel of this blade be near? For culling, which knows no pixels.
SHARED_FN bool handover_may_be_near(float rank, float distance_m, vec2 band, int mode) {
    if (mode == kHandoverOff) {
        return distance_m < band.y;
    }
    return handover_near(rank, distance_m, band, 0.0f, mode);
}

// Distance at which g equals `share`: the smoothstep inverted.
SHARED_FN float handover_distance(float share, vec2 band) {
    float x = 1.0f - clamp(share, 0.0f, 1.0f);
    float t = 0.5f - sin(asin(1.0f - 2.0f * x) / 3.0f);
    return mix(band.x, band.y, t);
}

// How far a blade's pose has moved to its shell image's, 0..1: complete before its own swap begins.
SHARED_FN float pose_share(float rank, float distance_m, vec2 band) {
    float swap = handover_distance(min(rank + kSwapWidth, 1.0f), band);
    return smoothstep(0.2f * swap, max(0.92f * swap, 1e-3f), distance_m); // the band may start at 0
}

// J7's distance test, for blades that have no far tier. Share of them that stands at a distance
// along the surface: all at the eye, kLeastShare of them from `thin_out` (m) on, 0: everywhere all.
// The paper's n levels without their steps.
SHARED_CONST float kLeastShare = 0.125f;
SHARED_FN float distance_share(float along_m, float thin_out) {
    return thin_out > 0.0f ? max(1.0f - (1.0f - kLeastShare) * along_m / thin_out, kLeastShare)
                           : 1.0f;
}

// Factor on a blade's width there, 0: gone. It grows thin over kThinRanks before it goes, none
// pops; those that stay take what the others lose, so that the mean over all ranks is 1 at any
// share.
SHARED_CONST float kThinRanks = 0.1f;
SHARED_FN float distance_width(float rank, float share) {
    float edge = share * (1.0f + kThinRanks);
    float over = max(edge - 1.0f, 0.0f);
    float above = kThinRanks - over;
    float mean = over > 0.0f ? 1.0f - 0.5f * above * above / kThinRanks
                             : edge - 0.5f * kThinRanks; // the ramp begins above rank 0
    return clamp((edge - rank) / kThinRanks, 0.0f, 1.0f) / mean;
}

// How much of a living blade's own pose is left of it there, 1..0: what pushed it stays in sight
// for longer than the wind's small differences do, and is gone where the pose has become the shell
// image's.
SHARED_FN float own_pose_share(float rank, float distance_m, vec2 band) {
    float swap = handover_distance(min(rank + kSwapWidth, 1.0f), band);
    return 1.0f - smoothstep(0.6f * swap, max(0.92f * swap, 1e-3f), distance_m);
}

// Threshold of a pixel on a 4 x 4 ordered grid, (n + 0.5) / 16 (Bayer 1973).
SHARED_FN float pixel_threshold(ivec2 pixel) {
    int x = pixel.x & 3;
    int y = pixel.y & 3;
    int a = x ^ y;
    int n = ((a & 1) << 3) | ((y & 1) << 2) | (a & 2) | ((y & 2) >> 1);
    return (float(n) + 0.5f) / 16.0f;
}

// The slice families' share: a slice across an axis shows a blade while seed / density <
// |component| of the unit horizontal view direction, so that the two families never add to more
// than the blade has.
SHARED_FN bool slice_shows(float seed, float density, float direction_component) {
    return seed < density * abs(direction_component);
}

// Shells count as much as texgen's rays found that they should beside the slices; they keep the
// seeds that slices use last.
SHARED_FN bool shell_shows(float seed, float density, float share) {
    return density - seed < density * share;
}

SHARED_END
#endif
