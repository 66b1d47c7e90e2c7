// SPDX-License-Identifier: Apache-2.0
// In: blocks of the clipmap (instances) and their samples. Out: the ground's vertices,
// anchor-relative.
#include "lib/frame.glsl"

layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks {
    TerrainBlock blocks[];
};
layout(std430, binding = BIND_BLOCK_SAMPLES) readonly buffer Samples {
    BlockSample samples[];
};

out vec3 world;
out vec2 sway;
out float gust; // place of the wind here among those that the far appearance knows

void main() {
    TerrainBlock block = blocks[gl_InstanceID];
    vec2 cell = vec2(gl_VertexID % (kBlockCells + 1), gl_VertexID / (kBlockCells + 1));
    vec2 xz = block.corner + cell * block.spacing_m;
    world = vec3(xz.x, samples[gl_InstanceID * kBlockPosts + gl_VertexID].height_m, xz.y);
    sway = samples[gl_InstanceID * kBlockPosts + gl_VertexID].sway;
    gust = far_wind_place(frame.wind, samples[gl_InstanceID * kBlockPosts + gl_VertexID].wind);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
