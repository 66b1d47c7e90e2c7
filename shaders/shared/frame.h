// SPDX-License-Identifier: Apache-2.0
// Constants of one view of one frame, uploaded once. "World" in shaders is relative to the anchor: a point near the eye on a
// 64 m grid (x, z) and a whole metre (y), chosen on the CPU in double precision.
#ifndef SWARD_SHARED_FRAME_H
#define SWARD_SHARED_FRAME_H
#include "shared/grass_layout.h"
#include "shared/lod.h"
#include "shared/shading.h"
#include "shared/track_field.h"
#include "shared/types.h"
#include "shared/wind.h"

SHARED_BEGIN

SHARED_CONST int kMaxClipLevels = 16;
SHARED_CONST float kNear_m = 0.05f; // near plane where a camera names no other
SHARED_CONST int kClipCells = 128; // posts a side of a clipmap level; memory grows with its square

SHARED_CONST int kMaskNone = 0;    // density by the slope
SHARED_CONST int kMaskEndless = 1; // the mask's rim goes on outside it
SHARED_CONST int kMaskBounded = 2; // no grass outside it

struct FrameConstants {
    mat4 clip_from_world;
    mat4 world_from_clip;
    vec4 eye;         // world; w: focal length in pixels (pixels a metre covers at one metre)
    vec4 lod_eye;     // world place that tier selection measures from; w: time over kFlutterPeriod_s, its fraction
    vec4 patch_grid;  // offset of the anchor in its patch x, z (m); side (m); canopy (m)
    ivec4 patch_tile; // tile of the anchor x, z; variants; far levels
    vec4 grass;       // offset range (m), density scale, 1 where the ground takes over from the shells, anchor above the datum (m)
    ivec4 mode;       // hand-over mode; forced far level or -1; 1 when the far tier stands alone; height coding of the layers (B1)
    vec4 handover;    // band from blades to far level 0: start, end (m); width correction: wmin, wspan (pixels)
    vec4 pose_band;   // band in which poses meet: start, end (m); pixels a tessellated segment spans; mean blade width (m)
    vec4 far_bands[kMaxFarLevels]; // level k: start and end of its incoming band, start and end of its outgoing one (m)
    ivec4 clip_layout;             // levels of the clipmap; width and height of the picture (pixels); kMask*
    vec4 clip[kMaxClipLevels];     // level k: offset of the anchor in its period u, v; 1 / period (1/m); spacing (m)
    GrassAppearance looks[kMaxSpecies];
    Light light;
    WindField wind;
    TrackField tracks;
    vec4 soil;       // rgb; a: share of it under moss and litter (grass::Floor)
    vec4 rock;       // rgb; a: unused
    vec4 moss;       // likewise
    vec4 litter;     // likewise
    vec4 mask_place;  // of the density mask: u, v of the anchor; u, v a metre
    vec4 simulated;   // fade from living to grouped blades: start, end (m); blades a page's slot; unused
    float near_m;     // near plane; depth, which is reversed, holds it over the distance along the axis
    int anchor_x, anchor_z; // of the anchor, in kAnchorGrid_m
    float unused_a; // to 16 bytes
    vec4 land; // texel of the landcover (m; 0: there is none); greatest factor on height, 1 at least; 1 where heights differ; unused
};
#ifdef __cplusplus
static_assert(sizeof(FrameConstants) == 128 + 16 * 8 + 64 + 16 + 256 + 96 * kMaxSpecies + 64 + 112 + 48 + 112 + 16);
#endif

SHARED_CONST int kBlockCells = 8;
SHARED_CONST int kBlockPosts = 81; // (kBlockCells + 1)^2

// A block of kBlockCells^2 cells of one clipmap level. 16 bytes.
struct TerrainBlock {
    vec4 place; // world x, z of its corner (m); spacing (m); level
};

// A tile of the grass patch near the eye. 32 bytes.
struct BladeTile {
    vec2 corner; // world x, z (m)
    uint end;    // the blade after its last in the set
    uint page;   // number of its page + 1; 0: none
    uint lie;    // of the patch on it (shared/tile_lie.h)
    uint unused_a, unused_b, unused_c; // to 32 bytes
};

// glMultiDrawArraysIndirect's command. 16 bytes.
struct DrawCommand {
    uint vertices;
    uint instances;
    uint first;
    uint base_instance;
};

// Ground and wind at a vertex of a block: evaluated once, read by the ground, every shell and every slice over it. 48 bytes.
struct BlockSample {
    vec4 ground; // world y, grass density, cosine to the sun, tint
    vec4 motion; // dy/dx, dy/dz of the ground; wind x, z (m/s)
    vec4 sway;   // canopy_sway; x, z of where the bend turns an upright blade at kLeanHeight
};

// Shares of the blades that the raster schemes' families show, by view elevation.
SHARED_CONST int kShareSteps = 12; // of 7.5 degrees
struct FarShares {
    vec4 shells[kShareSteps + 1]; // xyzw: far level
    vec4 slices[kShareSteps + 1]; // x
};

// A shell or a slice of one block. 32 bytes.
struct FarInstance {
    vec4 place;  // rest height (shells) or the plane's own coordinate (slices), world (m); block; cells to draw: first + 16 *
                 // end along x (shells) or along the slice; the same along z (shells)
    ivec4 image; // index of the image within its variant (planes counted), planes of one variant, axis (slices), level
};
#ifdef __cplusplus
static_assert(sizeof(DrawCommand) == 16 && sizeof(TerrainBlock) == 16 && sizeof(BladeTile) == 32 && sizeof(BlockSample) == 48 && sizeof(FarInstance) == 32 && sizeof(FarShares) == 2 * 208);
#endif

SHARED_END
#endif
