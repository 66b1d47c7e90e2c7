// SPDX-License-Identifier: Apache-2.0
// In: blocks of the clipmap (instances). Out: the ground's vertices, anchor-relative.
#include "lib/ground.glsl"

layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks { TerrainBlock blocks[]; };

out vec3 world;

void main() {
    TerrainBlock block = blocks[gl_InstanceID];
    vec2 cell = vec2(gl_VertexID % 9, gl_VertexID / 9);
    vec2 xz = block.place.xy + cell * block.place.z;
    world = vec3(xz.x, ground_at(xz), xz.y);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
