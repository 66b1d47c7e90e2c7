// SPDX-License-Identifier: Apache-2.0
// Binding points and workgroup sizes: names that C++ and every shader share. docs/architecture.md
// says who binds what.
#ifndef SWARD_SHARED_BINDINGS_H
#define SWARD_SHARED_BINDINGS_H

// Uniform blocks.
#define BIND_FRAME 0
#define BIND_SURFACE 1
#define BIND_WIND_GRID 2  // WindGrid: the fluid that the wind passes work on
#define BIND_WIND_FIELD 3 // WindField: the ambient wind at a window's rim
#define BIND_MARCH 5      // MarchMedium: the set as the far field knows it
#define BIND_FAR_SHARES 6 // FarShares: of a raster scheme
#define BIND_PHYSICS 4    // BladeStep, WindField: of one step of the blades
#define BIND_SAMPLES 4 // SampleRound: the pictures that share a choice of blades; beside no physics

// Storage blocks; GL 4.5 promises 0 to 7.
#define BIND_BLADES 0        // BladeRecord[], the set's
#define BIND_BLADE_TILES 1   // BladeTile[], the tiles around the eye
#define BIND_CULL_ITEMS 2    // uvec2[]: tile, first blade of a workgroup
#define BIND_SURVIVORS 3     // uvec2[]: survivors of each workgroup in its own segment: tile, blade
#define BIND_DRAW_COMMANDS 4 // DrawCommand[]: one a workgroup
#define BIND_CULL_TOTAL 5    // uint[CULL_COUNTS]: survivors of all batches, and what each test took
#define BIND_TERRAIN_BLOCKS 6 // TerrainBlock[]
#define BIND_MARCH_COUNTS 5   // uint[2]: steps of the march, texels that it read; beside no total
#define BIND_FAR_INSTANCES 4  // FarInstance[]; never beside the draw commands
#define BIND_BLOCK_SAMPLES 7  // BlockSample[]: kBlockPosts a block

#define BIND_CHOICE_ITEMS 3 // cull items where the choice by samples reads them, beside states
#define BIND_CHOICE_MASKS                                                                          \
    4 // uint[]: 16 bits a blade of an item, a picture each: does a sample fall on it?
#define BIND_CHOICE_TOTAL 6 // the cull's total there; beside no terrain blocks
#define BIND_GATHER_MASKS 5 // the same masks, where draws are made of them

#define BIND_BLADE_STATES                                                                          \
    2 // vec4[]: states of living blades, for the drawing; beside no cull items
#define BIND_BLADE_PLACES                                                                          \
    5 // uint[]: place of a blade in its variant's Morton order; beside no total

// Storage blocks of the blades' physics, which runs before they are drawn.
#define BIND_PHYSICS_BLADES 0   // BladeRecord[]: the set's, each variant in Morton order
#define BIND_PHYSICS_PAGES 1    // BladePage[]
#define BIND_PHYSICS_STATES 2   // vec4[]: CULL_GROUP a patch
#define BIND_PHYSICS_PATCHES 3  // PatchState[]
#define BIND_PHYSICS_AWAKE 4    // uint[]: patches to step
#define BIND_PHYSICS_DISPATCH 5 // their number, as an indirect dispatch, and the sum of all steps
#define BIND_PHYSICS_LISTS 6    // uint[]: first, count of each patch's spheres; their numbers
#define BIND_PHYSICS_SPHERES 7  // vec4[]: place and radius now, place a step ago

// Storage blocks of the wind passes, which run before all others.
#define BIND_WIND_U 0              // float[]: velocity x at west faces
#define BIND_WIND_V 1              // float[]: velocity z at north faces
#define BIND_WIND_SOLID 2          // uint[]: 0 air, else solid
#define BIND_WIND_SOLID_VELOCITY 3 // vec2[]
#define BIND_WIND_FORCES 4         // what pushes the air; 4 to 7 are free for a pass's own buffers
#define BIND_WIND_SOLIDS 4         // WindSolid[]: what stands in it
#define BIND_WIND_TILES 5          // ivec4[]: tiles that a force or solid touches
#define BIND_WIND_TILE_ITEMS 6     // uint[]: numbers of the forces or solids of each tile
#define BIND_WIND_INFLOW 7         // float[]: divergence that radial sources bring
#define BIND_WIND_FOOTPRINTS 7     // uint[]: bits of meshes' footprints
#define BIND_WIND_U_NEXT 4         // float[], written by the advection
#define BIND_WIND_V_NEXT 5
#define BIND_WIND_EARLIER_PRESSURE 3 // float[]: of the step before the last
#define BIND_WIND_NEXT_PRESSURE 3    // float[]: of the next Jacobi sweep, in the published scheme
#define BIND_WIND_LAST_PRESSURE 2    // float[]: of the last step, for the advection
#define BIND_WIND_DIRECTION                                                                        \
    0 // float[]: conjugate gradients: last direction of search, the next one, its product with
#define BIND_WIND_NEXT_DIRECTION 1 // the operator, sums of workgroups and what follows from them
#define BIND_WIND_PRODUCT 2
#define BIND_WIND_PARTIALS 3  // vec2[]
#define BIND_WIND_SCALARS 7   // alpha, beta, last (residual, correction)
#define BIND_WIND_U_CARRIED 5 // float[]: what the next advection carries, written by the projection
#define BIND_WIND_V_CARRIED 7
#define BIND_WIND_V_ENTERING 6 // the same, of cells that the window comes to
#define BIND_WIND_PRESSURE 4   // float[]: pressure * step / (density * cell)
#define BIND_WIND_PHI 4        // float[]: its correction, all levels of the multigrid
#define BIND_WIND_RHS 5     // float[]: residual of the pressure, right sides of the coarser levels
#define BIND_WIND_WEIGHTS 6 // uint[]: how open a cell's faces are, all levels
#define BIND_WIND_VORTICITY 7    // float[]: at north-west corners (1/s)
#define BIND_WIND_CELLS 7        // vec4[]: velocity at centres, previous and latest state
#define BIND_WIND_DRAWN_INFLOW 7 // float[]: divergence that the projection leaves (1/s)
#define BIND_WIND_TARGET                                                                           \
    4 // vec2[]: three groups of two stream functions a corner, what the ambient wind is drawn to
#define BIND_WIND_TOTALS 5 // float[]: mean and mean square of the ambient tile

// Storage blocks of the tracks' passes, which run before the blades' physics.
#define BIND_TRACK_BENDS 0   // vec4[]: theta, omega; a cell of a block that moves
#define BIND_TRACK_CHANGES 1 // vec4[]: their changes in the last step
#define BIND_TRACK_TABLE                                                                           \
    2 // ivec4[]: the table of pages, then where each page's blocks are in the pool of what moves
#define BIND_TRACK_WORK 3   // TrackBlock[]: what is stepped or shown
#define BIND_TRACK_PRINTS 4 // TrackPrint[]: page by page
#define BIND_TRACK_SHOWN                                                                           \
    5 // uint[]: kTrackWords a page: what lies pressed in its cells, then what coarser levels show
#define BIND_TRACK_MAPS 6 // vec4[]: undersides of meshes (shared/track_map.h)

// Texture units.
#define TEX_CLIP_HEIGHT 0  // R32F array: height above the datum, a level a layer
#define TEX_CLIP_SURFACE 1 // RGBA8 array: normal x, z, density, tint
#define TEX_FAR_IMAGES 2   // RGBA8 array: layers or slices of one far level
#define TEX_PHYSICS_BLADES                                                                         \
    2 // RGBA32F buffer: records of the blades that are stepped, four texels each; beside no far
      // images
#define TEX_FAR_APPEARANCE 3 // RGBA16F: canopy radiance and coverage by view azimuth, elevation
#define TEX_ELEVATION 4      // R32F: the posts
#define TEX_MASK 5           // R8: density mask
#define TEX_RESOLVE_COLOR 6
#define TEX_RESOLVE_DATA 7
#define TEX_RESOLVE_TANGENT 8
#define TEX_RESOLVE_NORMAL 9
#define TEX_RESOLVE_DEPTH 10
#define TEX_WIND_AMBIENT 11  // RGBA32F buffer: cells of the ambient tile, previous and latest state
#define TEX_WIND_LOCAL 12    // RGBA32F buffer: cells of the local window likewise
#define TEX_DEPTH_PYRAMID 13 // R32F: farthest depth of the opaque scene, a level a mip
#define TEX_MARCH_DENSITY 16 // RGBA16F array of one kind of march: albedo times density, density
#define TEX_MARCH_FIBRES 17  // RGBA8 array, likewise: mean tangent and rank
#define TEX_MARCH_CORRECTION                                                                       \
    18 // RGBA32F array: factors on optical depth and light for two densities, by elevation, half
       // mip; kind
#define TEX_CANOPY_DEPTH 19  // depth of the canopy's upper surface
#define TEX_CANOPY_GROUND 20 // RGBA16F: slope of the ground under it, density, tint
#define TEX_CANOPY_AIR 21    // RGBA16F: wind, canopy_sway
#define TEX_MARCH_LIGHT                                                                            \
    26 // RGBA16F array: factors on the march's light by view azimuth, elevation; a channel a wind;
       // of a mesh by the sun's height
#define TEX_SECOND_DEPTH                                                                           \
    22 // of a mesh's canopy, likewise: where a ray that has left it comes to another part of it
#define TEX_SECOND_GROUND 23
#define TEX_SECOND_AIR 24
#define TEX_CANOPY_SAMPLES 27 // depth of the canopy's upper surface, a value a sample of the scene
#define TEX_CANOPY_EXIT                                                                            \
    25 // RGBA16F: length of a ray's way through a mesh's canopy and the height where it ends (m);
       // the same of its second part
#define TEX_TRACK_BENDS 14 // RGBA32F buffer: theta, omega of the blocks that move
#define TEX_TRACK_SHOWN 28 // R32UI buffer: kTrackWords a page
#define TEX_TRACK_TABLE                                                                            \
    29 // RGBA32I buffer: page x, z; its slot, -1: none; 1 where something moves: a hashed table;
       // then each slot's blocks
#define TEX_LAND_SHADOW                                                                            \
    30 // RG16F: heights over the ground at which the sun begins to be seen and is wholly seen (m)
#define TEX_FAR_SHAPES                                                                             \
    15 // BC5 array beside far_images, where the set has one: tangent and root offset of its images
#define TEX_LAND_COVER                                                                             \
    32 // RGBA8: of a landcover factor on height times where grass may stand, dryness, share of
       // water, of asphalt
#define TEX_LAND_GROUND 33 // RGBA8: share of gravel, of sand, of rock; where no grass can stand

#define CULL_GROUP 128  // blades a workgroup; a chunk of a tile's list
#define GATHER_ITEMS 16 // chunks that a lane gathers into draws
#define GATHER_GROUP 8  // lanes a workgroup of it
#define PYRAMID_GROUP 8 // depth pyramid: 8 x 8 texels
#define WAKE_GROUP 64   // patches a workgroup that looks which are awake
#define SAMPLE_GROUP 64 // block samples: vertices a workgroup
#define CLIP_GROUP 8    // clipmap update: 8 x 8 texels

#define WIND_GROUP_X 32 // wind passes: cells a workgroup; rows lie together in memory
#define WIND_GROUP_Y 4
#define WIND_SOLVE_GROUP 256 // threads that solve the coarsest level, and that add up sums
#define WIND_SOLVE_SIDE 64   // its greatest side; shared memory holds it
#define TRACK_GROUP 16       // tracks: 16 x 16 cells
#define WIND_TILE                                                                                  \
    16 // forces and solids are binned by tiles of so many cells a side; one workgroup each

// What the cull pass counts, and the bits that switch its tests (J7).
#define CULL_KEPT 0
#define CULL_LEFT 1 // density, hand-over: the blade is not there, or another tier's
#define CULL_FRUSTUM 2
#define CULL_ORIENTATION 3
#define CULL_DISTANCE 4
#define CULL_OCCLUSION 5
#define CULL_SAMPLES 6 // no sample falls on it; of the reference
#define CULL_COUNTS 7

// Fragment outputs.
#define OUT_COLOR 0
#define OUT_DATA 1 // tier, coverage, rank
#define OUT_TANGENT 2
#define OUT_NORMAL 3

#endif
