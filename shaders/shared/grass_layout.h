// SPDX-License-Identifier: Apache-2.0
// Where things lie in a grass set's texture arrays, and how a texel is coded. Two RGBA8 planes an
// image:
//   plane 0 "id":    R share 0..1 of the texel covered by any blade of the slab; of the one that
//   covers most of it:
//                    G rank, B seed, A species and place along the blade v (0 root .. 1 tip): 3 + 5
//                    bits
//   plane 1 "shape": RG tangent x, z as t * 0.5 + 0.5 (its y is >= 0), BA offset from the texel's
//   centre (on the layer's or
//                    slice's own plane) to the blade's root in x, z: o / offset_range * 0.5 + 0.5
// Images are sampled nearest: a texel belongs to one blade. In layers u runs along +x and v along
// +z; in x-slices (planes x = const) u runs along +z, in z-slices (planes z = const) along +x, and
// v up from the ground to the canopy's top.
#ifndef SWARD_SHARED_GRASS_LAYOUT_H
#define SWARD_SHARED_GRASS_LAYOUT_H
#include "shared/blade.h"
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kPlanes = 2;
SHARED_CONST int kPlaneId = 0;
SHARED_CONST int kPlaneShape = 1;
SHARED_CONST int kAxisX = 0; // slices across x: planes x = const
SHARED_CONST int kAxisZ = 1;

// B1: one image stands for all layers, and R of its id plane is the height of the blade seen from
// above, not coverage. Linear, or top-weighted: finer near the canopy's top, where shells are seen.
SHARED_CONST int kHeightNone = 0; // an image a layer
SHARED_CONST int kHeightLinear = 1;
SHARED_CONST int kHeightTop = 2;

// Height over the canopy's that a code in [0, 1] stands for, and back.
SHARED_FN float decode_height(float code, int coding) {
    return coding == kHeightTop ? 1.0f - (1.0f - code) * (1.0f - code) : code;
}
SHARED_FN float encode_height(float height, int coding) {
    return coding == kHeightTop ? 1.0f - sqrt(max(1.0f - height, 0.0f)) : height;
}

// Array index of layer `layer` (0 lowest) of `count`.
SHARED_FN int layer_index(int variant, int layer, int count, int plane) {
    return (variant * count + layer) * kPlanes + plane;
}

// Array index of slice `slice` of `count` on `axis`.
SHARED_FN int slice_index(int variant, int axis, int slice, int count, int plane) {
    return ((variant * 2 + axis) * count + slice) * kPlanes + plane;
}

SHARED_FN vec3 decode_tangent(vec2 rg) {
    vec2 xz = rg * 2.0f - 1.0f;
    return vec3(xz.x, sqrt(max(1.0f - dot(xz, xz), 0.0f)), xz.y);
}

SHARED_FN vec2 decode_offset(vec2 ba, float offset_range) {
    return (ba * 2.0f - 1.0f) * offset_range;
}

SHARED_CONST int kMaxSpecies = 8; // of a set: three bits of a texel
SHARED_CONST int kAlongSteps = 32;

// Byte of a texel's A for a species and a place along the blade, and back.
SHARED_FN int encode_place(int species, float along) {
    return species * kAlongSteps + clamp(int(along * float(kAlongSteps)), 0, kAlongSteps - 1);
}
SHARED_FN int decode_species(int code) {
    return code / kAlongSteps;
}
SHARED_FN float decode_along(int code) {
    return (float(code % kAlongSteps) + 0.5f) / float(kAlongSteps);
}

// Weights and powers of G4: kd, pd, ks, ps. 16 bytes.
struct GrassGloss {
    float diffuse;
    float diffuse_power;
    float specular;
    float specular_power;
};

// How a species looks to the shading function (linear reflectance), and the outline of its blades.
// 96 bytes.
struct GrassAppearance {
    vec3 root;          // colour there
    float dry_share;    // of blades, 0..1
    vec3 tip;           // colour there
    float variation;    // of hue and value between blades, 0..1
    vec3 dry;           // colour of a dry blade
    float translucency; // 0..1
    GrassGloss gloss;
    vec3 head;    // colour of the head: seeds, petals, the blade of a leaf
    float unused; // to 16 bytes
    BladeOutline outline;
};
#ifdef __cplusplus
static_assert(sizeof(GrassGloss) == 16 && sizeof(GrassAppearance) == 96);
#endif

SHARED_END
#endif
