// SPDX-License-Identifier: Apache-2.0
// Constants of one view of one frame, uploaded once. "World" in shaders is relative to the anchor:
// a point near the eye on a 64 m grid (x, z) and a whole metre (y), chosen on the CPU in double
// precision.
#ifndef SWARD_SHARED_FRAME_H
#define SWARD_SHARED_FRAME_H
#include "shared/air.h"
#include "shared/grass_layout.h"
#include "shared/lod.h"
#include "shared/shading.h"
#include "shared/track_field.h"
#include "shared/types.h"
#include "shared/wind.h"

SHARED_BEGIN

SHARED_CONST int kMaxClipLevels = 16;
SHARED_CONST float kNear_m = 0.05f; // near plane where a camera names no other
SHARED_CONST int kClipCells = 128;  // posts a side of a clipmap level; memory grows with its square

SHARED_CONST int kMaskNone = 0;    // density by the slope
SHARED_CONST int kMaskEndless = 1; // the mask's rim goes on outside it
SHARED_CONST int kMaskBounded = 2; // no grass outside it

// Where a level of the clipmap lies. 16 bytes.
struct ClipLevel {
    vec2 offset;     // of the anchor in its period u, v
    float per_m;     // 1 / period
    float spacing_m; // of its posts
};

// Where a far level comes in and goes: start and end (m). 16 bytes.
struct FarBand {
    vec2 incoming;
    vec2 outgoing;
};

struct FrameConstants {
    mat4 clip_from_world;
    mat4 world_from_clip;
    vec3 eye;            // world
    float focal_px;      // pixels that a metre covers at one metre
    vec3 lod_eye;        // world place that tier selection measures from
    float flutter_time;  // time over kFlutterPeriod_s, its fraction
    vec2 patch_offset_m; // of the anchor in its patch x, z
    float patch_side_m;
    float canopy_m;
    ivec2 anchor_tile; // tile of the anchor x, z
    int patch_variants;
    int far_levels;
    float offset_range_m; // of the far images' root offsets
    float density_scale;
    float ground_takes_over; // 1 where it stands for the grass behind the shells, 0 where no tier
                             // hands it any
    float anchor_height_m;   // above the datum
    int handover_mode;       // kHandover*
    int forced_level;        // far level alone, at every distance, or -1
    int far_alone;           // 1: the far tier from the eye on
    int height_coding;       // of the layers (B1), kHeight*
    vec2 handover_band;      // from blades to far level 0: start, end (m)
    float width_least_px;    // width correction: wmin, wspan
    float width_span_px;
    vec2 pose_band;      // in which poses meet: start, end (m)
    float segment_px;    // that a tessellated segment spans
    float blade_width_m; // mean
    FarBand far_bands[kMaxFarLevels];
    ivec2 picture_px; // width, height
    int clip_levels;
    int mask_mode; // kMask*
    ClipLevel clip[kMaxClipLevels];
    GrassAppearance looks[kMaxSpecies];
    Light light;
    WindField wind;
    TrackField tracks;
    vec3 soil;
    float soil_cover; // share of it under moss and litter (grass::Floor)
    vec4 rock;        // rgb, as the two below
    vec4 moss;
    vec4 litter;
    vec2 mask_offset; // of the density mask: u, v of the anchor
    vec2 mask_per_m;  // u, v a metre
    vec2 living_band; // fade from living to grouped blades: start, end (m)
    int page_blades;  // that a page's slot holds
    float near_m; // near plane; depth, which is reversed, holds it over the distance along the axis
    int anchor_x, anchor_z; // of the anchor, in kAnchorGrid_m
    int unused_a, unused_b; // to 16 bytes
    Air air;
    vec2 shadow_offset; // of the land's shadow: u, v of the anchor
    vec2 shadow_per_m;  // u, v a metre
    float has_shadow;   // 1 where the land's shadow is known
    float land_texel_m; // of the landcover; 0: there is none
    float land_highest; // greatest factor on height, 1 at least
    float land_uneven;  // 1 where heights differ
};
#ifdef __cplusplus
static_assert(sizeof(ClipLevel) == 16 && sizeof(FarBand) == 16);
static_assert(sizeof(FrameConstants) == 128 + 16 * (8 + kMaxFarLevels + 1 + kMaxClipLevels + 7) +
                                            sizeof(GrassAppearance) * kMaxSpecies + sizeof(Light) +
                                            sizeof(WindField) + sizeof(TrackField) + sizeof(Air) +
                                            32);
#endif

SHARED_CONST int kBlockCells = 8;
SHARED_CONST int kBlockPosts = 81; // (kBlockCells + 1)^2

// A block of kBlockCells^2 cells of one clipmap level. 16 bytes.
struct TerrainBlock {
    vec2 corner; // world x, z (m)
    float spacing_m;
    int level;
};

// A tile of the grass patch near the eye. 32 bytes.
struct BladeTile {
    vec2 corner;                       // world x, z (m)
    uint end;                          // the blade after its last in the set
    uint page;                         // number of its page + 1; 0: none
    uint lie;                          // of the patch on it (shared/tile_lie.h)
    uint unused_a, unused_b, unused_c; // to 32 bytes
};

// glMultiDrawArraysIndirect's command. 16 bytes.
struct DrawCommand {
    uint vertices;
    uint instances;
    uint first;
    uint base_instance;
};

// Ground and wind at a vertex of a block: evaluated once, read by the ground, every shell and every
// slice over it. 48 bytes.
struct BlockSample {
    float height_m;   // of the ground, world y
    float density;    // of the grass
    float sun_cosine; // of the ground's normal to the sun
    float tint;
    vec2 slope; // dy/dx, dy/dz of the ground
    vec2 wind;  // x, z (m/s)
    vec2 sway;  // canopy_sway
    vec2 bend;  // x, z of where it turns an upright blade at kLeanHeight
};

// Shares of the blades that the raster schemes' families show, by view elevation.
SHARED_CONST int kShareSteps = 12; // of 7.5 degrees
struct FarShare {
    vec4 shells; // by far level
    float slices;
    float unused_a, unused_b, unused_c; // to 32 bytes
};
struct FarShares {
    FarShare steps[kShareSteps + 1];
};

// A shell or a slice of one block. 40 bytes.
struct FarInstance {
    float place_m; // rest height (shells) or the plane's own coordinate in the world (slices)
    int block;
    ivec2 along; // cells to draw along x (shells) or along the slice: the first, one after the last
    ivec2 across; // along z (shells)
    int image;    // its index within its variant, planes counted
    int planes;   // of one variant
    int axis;     // of a slice
    int level;
};
#ifdef __cplusplus
static_assert(sizeof(DrawCommand) == 16 && sizeof(TerrainBlock) == 16 && sizeof(BladeTile) == 32);
static_assert(sizeof(BlockSample) == 48 && sizeof(FarInstance) == 40 &&
              sizeof(FarShares) == 32 * (kShareSteps + 1));
#endif

SHARED_END
#endif
