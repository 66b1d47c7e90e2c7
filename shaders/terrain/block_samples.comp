// SPDX-License-Identifier: Apache-2.0
// In: visible blocks. Out: ground and wind at each of their vertices.
#include "lib/ground.glsl"
#include "lib/sway.glsl"

layout(local_size_x = SAMPLE_GROUP) in;
layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks {
    TerrainBlock blocks[];
};
layout(std430, binding = BIND_BLOCK_SAMPLES) writeonly buffer Samples {
    BlockSample samples[];
};
uniform int sample_count;

void main() {
    int index = int(gl_GlobalInvocationID.x);
    if (index >= sample_count) {
        return;
    }
    TerrainBlock block = blocks[index / kBlockPosts];
    int post = index % kBlockPosts;
    vec2 xz =
        block.corner + vec2(post % (kBlockCells + 1), post / (kBlockCells + 1)) * block.spacing_m;
    Ground ground = ground_surface(xz, block.spacing_m);
    vec2 slope = -ground.normal.xz / max(ground.normal.y, 0.1);
    float height = ground_at(xz);
#ifdef FINE_GROUND
    if (is_fine(xz)) {
        height = fine_vertex(xz, clip_place(xz));
    }
#endif
    vec2 wind = wind_at(xz);
    vec4 swaying = sway_at(vec3(xz.x, height, xz.y), wind);
    samples[index] = BlockSample(height, ground.density, dot(ground.normal, frame.light.to_sun),
                                 ground.tint, slope, wind, swaying.xy, swaying.zw);
}
