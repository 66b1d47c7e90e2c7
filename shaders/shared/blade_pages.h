// SPDX-License-Identifier: Apache-2.0
// Where the states of living blades lie: a page a tile, in slots of a pool; a page is a run of
// patches (J3) of CULL_GROUP blades, neighbours on the ground, in the Morton order of their
// variant.
#ifndef SWARD_SHARED_BLADE_PAGES_H
#define SWARD_SHARED_BLADE_PAGES_H
#include "shared/types.h"

SHARED_BEGIN

// A slot of the pool. 32 bytes. On a mesh a page is one cluster of it.
struct BladePage {
    vec3 origin;  // anchor-relative (m): of the tile's corner x, z; of a mesh
    float side_m; // of the patch, unused of a mesh
    int first;    // blade of its variant in the Morton order
    int blades;   // in it, 0: the slot is free
    int records;  // number of the buffer of records
    uint lie;     // of the patch on the tile (shared/tile_lie.h), unused of a mesh
};

SHARED_CONST uint kPatchFree = 0u;
SHARED_CONST uint kPatchNew = 1u; // its blades take up the grouped pose in the next step
SHARED_CONST uint kPatchAwake = 2u;
SHARED_CONST uint kPatchAsleep =
    3u; // nothing moves: skipped until the wind changes or a collider comes

// 16 bytes.
struct PatchState {
    vec2 wind; // at the patch's first blade in its last step (m/s)
    uint status;
    uint steps; // since it was set up, for the statistics
};

// A step takes its patches by lists, each with a program of its own.
SHARED_CONST uint kListFree = 0u;      // awake, and no collider meets them
SHARED_CONST uint kListColliding = 1u; // some collider may
SHARED_CONST uint kListNew = 2u;       // their blades begin
SHARED_CONST uint kPatchLists = 3u;

// An entry of a list: all that a workgroup must know of its patch before it looks at a blade. 48
// bytes.
struct AwakePatch {
    BladePage page;
    uvec2 colliders; // their first number and their count
    uint number;     // of the patch
    uint status;     // kPatch*
};
#ifdef __cplusplus
static_assert(sizeof(BladePage) == 32 && sizeof(PatchState) == 16 && sizeof(AwakePatch) == 48);
#endif

// A patch falls asleep when no blade remembers a push and none moves by more than this part of its
// length in a step; it then is within a thirtieth of a percent of its balance.
SHARED_CONST float kStillMove = 2e-6f;
SHARED_CONST float kStillWind_mps = 0.002f; // change of wind that wakes it

// Weight of the simulated pose against the grouped one at a distance from the eye; band: start and
// end of the fade (m).
SHARED_FN float simulated_share(float distance_m, vec2 band) {
    return 1.0f - smoothstep(band.x, band.y, distance_m);
}

SHARED_END
#endif
