// SPDX-License-Identifier: Apache-2.0
// Binding points and workgroup sizes: names that C++ and every shader share. docs/architecture.md says who binds what.
#ifndef SWARD_SHARED_BINDINGS_H
#define SWARD_SHARED_BINDINGS_H

// Uniform blocks.
#define BIND_FRAME 0
#define BIND_SURFACE 1

// Storage blocks; GL 4.5 promises 0 to 7.
#define BIND_BLADES 0          // BladeRecord[], the set's
#define BIND_BLADE_TILES 1     // BladeTile[], the tiles around the eye
#define BIND_CULL_ITEMS 2      // uvec2[]: tile, first blade of a workgroup
#define BIND_SURVIVORS 3       // uvec2[]: survivors of each workgroup in its own segment: tile, blade
#define BIND_DRAW_COMMANDS 4   // DrawCommand[]: one a workgroup
#define BIND_CULL_TOTAL 5      // uint: survivors of all batches
#define BIND_TERRAIN_BLOCKS 6  // TerrainBlock[]
#define BIND_FAR_INSTANCES 4   // FarInstance[]; never beside the draw commands
#define BIND_BLOCK_SAMPLES 7   // BlockSample[]: kBlockPosts a block

// Texture units.
#define TEX_CLIP_HEIGHT 0      // R32F array: height above the datum, a level a layer
#define TEX_CLIP_SURFACE 1     // RGBA8 array: normal x, z, density, tint
#define TEX_FAR_IMAGES 2       // RGBA8 array: layers or slices of one far level
#define TEX_FAR_APPEARANCE 3   // RGBA16F: canopy radiance and coverage by view azimuth, elevation
#define TEX_ELEVATION 4        // R32F: the posts
#define TEX_MASK 5             // R8: density mask
#define TEX_RESOLVE_COLOR 6
#define TEX_RESOLVE_DATA 7
#define TEX_RESOLVE_TANGENT 8
#define TEX_RESOLVE_NORMAL 9
#define TEX_RESOLVE_DEPTH 10
#define TEX_FAR_SHAPES 15       // BC5 array beside far_images, where the set has one: tangent and root offset of its images

#define CULL_GROUP 128         // blades a workgroup; a chunk of a tile's list
#define SAMPLE_GROUP 64        // block samples: vertices a workgroup
#define CLIP_GROUP 8           // clipmap update: 8 x 8 texels

// Fragment outputs.
#define OUT_COLOR 0
#define OUT_DATA 1             // tier, coverage, rank
#define OUT_TANGENT 2
#define OUT_NORMAL 3

#endif
