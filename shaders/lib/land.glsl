// SPDX-License-Identifier: Apache-2.0
// A landcover's classes as every tier sees them (docs/far-field.md): at once by the size of what is
// looked at. World xz in.
//
// Texels hold shares. Near the eye a border runs where a share passes a level that noise moves to
// and fro: crisp, ragged, never in the texels' squares. What is wider than a texel shows the shares
// themselves, whose mean that is.
#include "shared/sward.h"

layout(binding = TEX_LAND_COVER) uniform sampler2D land_cover;
layout(binding = TEX_LAND_GROUND) uniform sampler2D land_ground;

const float kMostHeight = 2.0;  // scene::kLandMostHeight
const float kEdgeRagged = 0.35; // of an octave's cells
const float kAllOrNone = 0.004; // a byte

// NO_LAND: in the longest programs of scenes without one, which are spared its code. A mesh never
// has one.
#if defined(NO_LAND) || defined(SURFACE)
const bool kMayHaveLand = false;
#else
const bool kMayHaveLand = true;
#endif

bool has_land() {
    return kMayHaveLand && frame.land_texel_m > 0.0;
}
bool has_heights() {
    return kMayHaveLand && frame.land_uneven > 0.0;
}
// Greatest height of grass over its height in the set, 1 at least.
float highest() {
    return kMayHaveLand ? frame.land_highest : 1.0;
}

// Place in the mask, and in the landcover, which has the same texels.
vec2 mask_uv(vec2 xz) {
    return xz * frame.mask_per_m + frame.mask_offset;
}
bool off_mask(vec2 uv) {
    return frame.mask_mode == kMaskBounded && clamp(uv, vec2(0.0), vec2(1.0)) != uv;
}

struct LandEdge {
    float level; // share from which on a place is a class's own
    float soft;  // half of the shares that are neither
};

// How far an octave of noise moves a border (m).
float edge_aside(vec2 xz, float size, float width, uint salt) {
    float share = octave_share(size, width);
    return share <= 0.0 ? 0.0
                        : kEdgeRagged * size * share *
                              cell_noise(xz, ivec2(frame.anchor_x, frame.anchor_z), size, salt);
}

// LAND_SMOOTH: without the noise, whose mean is 0; of the march, which asks at every step.
LandEdge land_edge(vec2 xz, float width) {
    float soft = clamp(0.5 * width / frame.land_texel_m, 0.01, 0.5);
#ifdef LAND_SMOOTH
    return LandEdge(0.5, max(soft, 0.15));
#else
    if (octave_share(1.0, width) <= 0.0) {
        return LandEdge(0.5, soft);
    }
    // From 1 m down to 6 cm; no loop, of which terrain.frag has enough.
    float aside = edge_aside(xz, 1.0, width, 0x1a4du) + edge_aside(xz, 0.5, width, 0x1a4eu) +
                  edge_aside(xz, 0.25, width, 0x1a4fu) + edge_aside(xz, 0.125, width, 0x1a50u) +
                  edge_aside(xz, 0.0625, width, 0x1a51u);
    float most = 0.8 * (0.5 - soft); // so that all is all, and none none
    return LandEdge(0.5 + clamp(aside / frame.land_texel_m, -most, most), soft);
#endif
}

float beyond_edge(float share, LandEdge edge) {
    return clamp(0.5 + (share - edge.level) / (2.0 * edge.soft), 0.0, 1.0);
}

// `density` of the mask at a place, with the border of what bears no grass.
float land_density(float density, vec2 xz, vec2 uv, float lod, float width) {
    float bare = textureLod(land_ground, uv, lod).a;
    if (bare <= kAllOrNone || bare >= 1.0 - kAllOrNone) {
        return bare >= 1.0 - kAllOrNone ? 0.0 : density;
    }
    return min(density / (1.0 - bare), 1.0) * (1.0 - beyond_edge(bare, land_edge(xz, width)));
}

float land_lod(float width) {
    return log2(max(width / frame.land_texel_m, 1.0));
}

// Factor on the height of grass.
float land_height(vec2 xz, float width) {
    vec2 uv = mask_uv(xz);
    if (!has_heights() || off_mask(uv)) {
        return 1.0;
    }
    float lod = land_lod(width);
    float bearing = 1.0 - textureLod(land_ground, uv, lod).a;
    float height = textureLod(land_cover, uv, lod).r;
    return bearing <= kAllOrNone ? 1.0
                                 : clamp(kMostHeight * height / bearing, 0.1, frame.land_highest);
}

float land_dryness(vec2 xz, float width) {
    vec2 uv = mask_uv(xz);
    return off_mask(uv) ? 0.0 : 2.0 * textureLod(land_cover, uv, land_lod(width)).g - 1.0;
}
