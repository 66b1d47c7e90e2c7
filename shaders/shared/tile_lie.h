// SPDX-License-Identifier: Apache-2.0
// How the patch lies on a tile of the plane: shifted round (it closes on itself), mirrored and
// turned, so that no two tiles look alike and the picture has no period. One hash of the tile, read
// by every tier.
//
// A shift is a whole number of eighths of the side, which are planes of every set of slabs: a slab
// of the patch is one of the tile. Over all shifts the sum of a tile's pattern is plain but for
// waves of an eighth of the side and shorter (docs/far-field.md).
#ifndef SWARD_SHARED_TILE_LIE_H
#define SWARD_SHARED_TILE_LIE_H
#include "shared/blade.h"
#include "shared/hash.h"

SHARED_BEGIN

SHARED_CONST int kLieShifts = 8; // a side
SHARED_CONST uint kLieAsGrown = 0u;

// A lie: bits 0 to 2 and 3 to 5 are the shift along x and z in eighths of the side; 6 and 7 mirror
// x and z; 8 swaps x and z, before all that.
SHARED_FN uint tile_lie(ivec2 tile) {
    return hash_ivec2(tile, 0x5eedu) & 511u; // tile_variant takes the high bits
}

SHARED_FN vec2 lie_mirror(uint lie) {
    return vec2(1.0f - 2.0f * float((lie >> 6u) & 1u), 1.0f - 2.0f * float((lie >> 7u) & 1u));
}
SHARED_FN bool lie_turned(uint lie) {
    return (lie & 256u) != 0u;
}
// In sides of the patch.
SHARED_FN vec2 lie_shift(uint lie) {
    return vec2(float(lie & 7u), float((lie >> 3u) & 7u)) * (1.0f / float(kLieShifts));
}

// x, z of a direction of the patch, as it lies.
SHARED_FN vec2 lie_along(uint lie, vec2 xz) {
    return (lie_turned(lie) ? vec2(xz.y, xz.x) : xz) * lie_mirror(lie);
}

// Place on a tile (in sides, from its corner) of a place of the patch, which is in [0, 1) again.
SHARED_FN vec2 lie_place(uint lie, vec2 place) {
    return fract(lie_along(lie, place) + lie_shift(lie));
}

// Place of the patch, for a texture that repeats, that lies at a place on a tile: lie_place
// backwards.
SHARED_FN vec2 lie_source(uint lie, vec2 place) {
    vec2 at = (place - lie_shift(lie)) * lie_mirror(lie);
    return lie_turned(lie) ? vec2(at.y, at.x) : at;
}

// A blade of the patch as it lies on a tile; its root is in [0, side) from the tile's corner. A
// mirror image's width runs from the other rim, so that its front is the mirror image of the front.
SHARED_FN BladeRecord lay_blade(uint lie, BladeRecord blade, float side) {
    BladeRecord laid = blade;
    vec2 root = lie_place(lie, vec2(blade.root.x, blade.root.y) / side) * side;
    vec2 v1 = lie_along(lie, vec2(blade.v1.x, blade.v1.z));
    vec2 v2 = lie_along(lie, vec2(blade.v2.x, blade.v2.z));
    laid.root.x = root.x;
    laid.root.y = root.y;
    laid.v1.x = v1.x;
    laid.v1.z = v1.y;
    laid.v2.x = v2.x;
    laid.v2.z = v2.y;
    float facing = lie_turned(lie) ? 0.5f * kPi - blade.shape.x : blade.shape.x;
    vec2 mirror = lie_mirror(lie);
    facing = mirror.x < 0.0f ? kPi - facing : facing;
    facing = mirror.y < 0.0f ? -facing : facing;
    laid.shape.x = (mirror.x * mirror.y < 0.0f) != lie_turned(lie) ? facing + kPi : facing;
    return laid;
}

SHARED_END
#endif
