// SPDX-License-Identifier: Apache-2.0
// Structure of the land that is finer than the clipmap holds: patches of lush and dry grass, and
// the floor under it. World-space noise, read by every tier at the width of what a pixel shows, so
// that near and far agree and nothing sparkles.
//
// Cells are powers of two of a metre, and the anchor stands on whole 64 m: a cell's number is exact
// wherever the land lies.
#ifndef SWARD_SHARED_SWARD_H
#define SWARD_SHARED_SWARD_H
#include "shared/hash.h"
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST float kAnchorGrid_m = 64.0f;
SHARED_CONST int kSwardOctaves =
    6; // of patches in the sward, from 32 m down to 1 m; each costs four hashes a pixel
SHARED_CONST float kSwardStrength =
    0.4f; // of an octave, in the tint's own unit: about 0.08 root mean square each
SHARED_CONST float kResolvedTo = 0.25f; // of a cell: a pixel up to so wide shows an octave whole
SHARED_CONST float kGoneFrom = 0.7f;    // and from so wide its mean alone, which is 0

SHARED_FN vec2 cell_slope(ivec2 cell, uint salt) {
    uint h = hash_ivec2(cell, salt);
    return vec2(float(h & 0xffffu), float(h >> 16u)) * (2.0f / 65535.0f) - 1.0f;
}

// Gradient noise (Perlin 2002) on cells of `size` metres, powers of two up to 32; mean 0, about
// -0.7 .. 0.7, root mean square 0.2. Cells lie at 27 degrees to the axes and are 0.9 `size` wide:
// their grid is not the land's. `anchor`: of the frame, in 64 m.
SHARED_FN float stretched_noise(vec2 xz, ivec2 anchor, vec2 size, uint salt) {
    vec2 p = vec2(2.0f * xz.x + xz.y, 2.0f * xz.y - xz.x) * 0.5f / size;
    vec2 base = floor(p);
    vec2 steps = kAnchorGrid_m * 0.5f / size;
    ivec2 cell = ivec2(int(base.x) + (2 * anchor.x + anchor.y) * int(steps.x),
                       int(base.y) + (2 * anchor.y - anchor.x) * int(steps.y));
    vec2 f = p - base;
    vec2 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    float n00 = dot(cell_slope(cell, salt), f);
    float n10 = dot(cell_slope(ivec2(cell.x + 1, cell.y), salt), vec2(f.x - 1.0f, f.y));
    float n01 = dot(cell_slope(ivec2(cell.x, cell.y + 1), salt), vec2(f.x, f.y - 1.0f));
    float n11 = dot(cell_slope(ivec2(cell.x + 1, cell.y + 1), salt), vec2(f.x - 1.0f, f.y - 1.0f));
    return mix(mix(n00, n10, w.x), mix(n01, n11, w.x), w.y);
}

SHARED_FN float cell_noise(vec2 xz, ivec2 anchor, float size, uint salt) {
    return stretched_noise(xz, anchor, vec2(size, size), salt);
}

// Share of an octave of cells of `size` that something `width` metres wide shows.
SHARED_FN float octave_share(float size, float width) {
    return 1.0f - smoothstep(kResolvedTo, kGoneFrom, width / size);
}

// Tint of the sward (0 lush .. 1 dry) at a place whose slow variation is `slow`, as something
// `width` metres wide shows it.
SHARED_FN float sward_patches(vec2 xz, ivec2 anchor, float slow, float width) {
    float sum = 0.0f;
    float size = 0.5f * kAnchorGrid_m;
    for (int i = 0; i < kSwardOctaves; ++i) {
        float share = octave_share(size, width);
        if (share <= 0.0f) {
            break;
        }
        sum += share * cell_noise(xz, anchor, size, 0x5a4du + uint(i));
        size *= 0.5f;
    }
    float u = 2.0f * (slow + kSwardStrength * sum) - 1.0f;
    return 0.5f + 0.5f * u *
                      inversesqrt(
                          1.0f + u * u); // no end is reached, none shows as an edge; the mean stays
}

// Dead stalks that lie on the ground, 0..1 across each: ridges of noise drawn long, along two
// directions that wander.
SHARED_CONST vec2 kStalk_m = vec2(0.125f, 0.015625f); // length and width of a cell
SHARED_CONST float kStalkWander_m = 0.04f;
SHARED_CONST float kStalkShare = 0.10f; // of the ground; what a pixel too wide to show them shows
SHARED_FN float stalks_at(vec2 xz, ivec2 anchor, float width) {
    float share = octave_share(2.0f * kStalk_m.y, width);
    if (share <= 0.0f) {
        return kStalkShare;
    }
    vec2 aside =
        vec2(cell_noise(xz, anchor, 0.25f, 0x57a3u), cell_noise(xz, anchor, 0.25f, 0x57a4u));
    vec2 at = xz + kStalkWander_m * 2.0f * aside;
    float one = abs(stretched_noise(at, anchor, kStalk_m, 0x57a1u));
    float two = abs(stretched_noise(at, anchor, vec2(kStalk_m.y, kStalk_m.x), 0x57a2u));
    return mix(kStalkShare, 1.0f - smoothstep(0.0f, 0.02f, min(one, two)), share);
}

// Ground under grass: crumbs, clods and what covers them. x: brightness over the mean; y: share
// under moss and litter, `cover` in the mean; z: share of that which is litter, more where the
// sward is dry.
SHARED_CONST int kFloorOctaves = 10; // from 2 m down to 4 mm
SHARED_CONST float kFloorEdge =
    0.16f; // half width of the edge of what is covered, in the noise's own unit
SHARED_CONST float kFloorSpread = 0.33f; // root mean square of the noise that cover hangs on: what
                                         // a pixel does not show of it softens the edge
SHARED_FN vec3 floor_at(vec2 xz, ivec2 anchor, vec2 cover_dry, float width) {
    float crumbs = 0.0f;
    float patches = 0.0f;
    float lost = 1.0f;
    float size = 2.0f;
    for (int i = 0; i < kFloorOctaves; ++i) {
        float share = octave_share(size, width);
        if (share <= 0.0f) {
            break;
        }
        float n = share * cell_noise(xz, anchor, size, 0xf100u + uint(i));
        crumbs += n * (i < 4 ? 0.2f : i < 7 ? 0.4f : 0.8f);
        float weight = i < 6 ? 0.62f : 0.3f;
        patches += n * weight;
        lost -= share * share * weight * weight * (1.0f / 2.67f); // the weights' squares, summed
        size *= 0.5f;
    }
    // A smoothstep of half width e is about a normal distribution's rise of spread 0.45 e. Together
    // with the noise's it is the same at any width, and its quantile at the cover is where the edge
    // lies (Tukey's lambda).
    float unseen = kFloorSpread * kFloorSpread * max(lost, 0.0f);
    float edge = sqrt(kFloorEdge * kFloorEdge + unseen / (0.45f * 0.45f));
    float whole = sqrt(kFloorSpread * kFloorSpread + 0.45f * 0.45f * kFloorEdge * kFloorEdge);
    float covered = clamp(cover_dry.x, 0.0f, 1.0f);
    float level = whole * (pow(covered, 0.135f) - pow(1.0f - covered, 0.135f)) * (1.0f / 0.1975f);
    float cover = covered <= 0.0f ? 0.0f : smoothstep(-edge, edge, patches + level);
    float stalks = stalks_at(xz, anchor, width);
    float litter =
        clamp(cover_dry.y - 0.1f + 0.8f * (patches - 1.2f * crumbs) + stalks, 0.0f, 1.0f);
    return vec3(max(1.0f + crumbs + 0.5f * stalks, 0.3f), cover, litter);
}

SHARED_END
#endif
