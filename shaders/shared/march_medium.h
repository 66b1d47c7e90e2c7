// SPDX-License-Identifier: Apache-2.0
// What the far field's march knows of a grass set beside its textures, and the sizes of those.
#ifndef SWARD_SHARED_MARCH_MEDIUM_H
#define SWARD_SHARED_MARCH_MEDIUM_H
#include "shared/grass_layout.h"
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kMarchLayers = 16; // of the columns; their edges lie where rays meet blades
SHARED_CONST int kMarchSets =
    3; // of slabs: kFinestSlabs, half and a quarter of them a patch and axis
SHARED_CONST int kFinestSlabs = 32;
SHARED_CONST int kMarchTexels =
    512; // a patch side holds so many of the finest texels, whose width mips count from
SHARED_CONST int kColumnBase = 1;       // the columns' finest mip
SHARED_CONST int kMarchColumns = 3;     // kind of a march: 0 to 2 a set of slabs, 3 the columns
SHARED_CONST int kMarchElevations = 19; // of the correction table: 0, 5 .. 90 degrees
SHARED_CONST int kMarchMips = 20;       // half mips of the correction table
// What the march knows of a set beside its textures. std140.
struct MarchMedium {
    // Edge i of the layers, from the ground (0) to the canopy's top: blade area that stands above
    // it over the ground's area, projected along x, from above, along z; w: its height (m).
    vec4 edges[kMarchLayers + 1];
    // Layer i: mean upright part of its blades' tangents; mean place along the blade; unused.
    vec4 layers[kMarchLayers];
    // Layer i: albedo as rays along the ground and rays from above see it, over the mean that the
    // columns hold.
    vec4 level_tint[kMarchLayers];
    vec4 steep_tint[kMarchLayers];
    // By elevation of a ray on level ground in a calm, 0, 5 .. 90 degrees: heights (m) above which
    // 5, 50 and 75 percent of what it sees lie; its whole mean optical depth, times the sine of the
    // elevation.
    vec4 views[kMarchElevations];
    // By elevation of a ray over the ground's plane, likewise: how far the blades that it sees lean
    // toward the eye (sine, mean) where the ground falls by half a metre a metre along the ray, is
    // level, and rises so; w: by how much higher they stand at rest, of the canopy's height, where
    // it rises so than on level ground. Blades stand upright on any ground: one that leans downhill
    // stands higher over the ground under its tip than it is long.
    vec4 slopes[kMarchElevations];
    GrassGloss gloss; // mean of the species by what is seen of them
    float side_m;     // of the patch
    float canopy_m;
    float translucency; // mean, likewise
    int variants;
};
#ifdef __cplusplus
static_assert(sizeof(MarchMedium) == 16 * (4 * kMarchLayers + 1 + 2 * kMarchElevations + 2));
#endif

// Depth that stands for a kind (a crest's: that of rays which may leave the canopy again): each is
// a pass over the pixels that have it.
SHARED_FN float kind_depth(int kind, bool crest) {
    return 0.0625f * float(kind + 1 + (crest ? 4 : 0));
}

SHARED_END
#endif
