// SPDX-License-Identifier: Apache-2.0
// In: the posts. Out: one clipmap level's heights above the datum (m).
#include "lib/posts.glsl"

layout(local_size_x = CLIP_GROUP, local_size_y = CLIP_GROUP) in;
layout(r32f, binding = 0) uniform writeonly image2D heights;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    // The post in this level's window that wraps onto this texel.
    ivec2 world = params.first + ((texel - params.first) & (kClipCells - 1));
    imageStore(heights, texel,
               vec4(surface_height(vec2(world) * params.spacing_m, params.spacing_m)));
}
