// SPDX-License-Identifier: Apache-2.0
// In: blocks of the clipmap (instances) and their samples. Out: the canopy's upper surface over
// them, as high as the wind leaves it.
#include "lib/frame.glsl"
#include "shared/bend.h"

layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks {
    TerrainBlock blocks[];
};
layout(std430, binding = BIND_BLOCK_SAMPLES) readonly buffer Samples {
    BlockSample samples[];
};

out vec4 ground; // slope dy/dx, dy/dz; density, tint
out vec4 air;    // wind, canopy_sway

void main() {
    TerrainBlock block = blocks[gl_InstanceID];
    vec2 cell = vec2(gl_VertexID % (kBlockCells + 1), gl_VertexID / (kBlockCells + 1));
    vec2 xz = block.corner + cell * block.spacing_m;
    BlockSample here = samples[gl_InstanceID * kBlockPosts + gl_VertexID];
    float canopy = frame.canopy_m;
    float top = frame.land_highest *
                (canopy + bend_offset(canopy, canopy, here.wind, frame.wind.response).y);
    ground = vec4(here.slope, here.density, here.tint);
    air = vec4(here.wind, here.sway);
    gl_Position = frame.clip_from_world * vec4(xz.x, here.height_m + top, xz.y, 1.0);
}
