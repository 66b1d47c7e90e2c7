// SPDX-License-Identifier: Apache-2.0
// In: the scene's depth (FIRST), or the level before. Out: a level of the pyramid, each texel the
// farthest of four.
#include "shared/bindings.h"

layout(local_size_x = PYRAMID_GROUP, local_size_y = PYRAMID_GROUP) in;
layout(r32f, binding = 0) writeonly uniform image2D target;

#ifdef FIRST
#ifdef MULTISAMPLED
layout(binding = TEX_RESOLVE_DEPTH) uniform sampler2DMS depth;
uniform int samples;
ivec2 source_size() {
    return textureSize(depth);
}
float farthest(ivec2 place) {
    float least = texelFetch(depth, place, 0).r;
    for (int s = 1; s < samples; ++s) {
        least = min(least, texelFetch(depth, place, s).r);
    }
    return least;
}
#else
layout(binding = TEX_RESOLVE_DEPTH) uniform sampler2D depth;
ivec2 source_size() {
    return textureSize(depth, 0);
}
float farthest(ivec2 place) {
    return texelFetch(depth, place, 0).r;
}
#endif
#else
layout(binding = TEX_DEPTH_PYRAMID) uniform sampler2D levels;
uniform int level;
ivec2 source_size() {
    return textureSize(levels, level - 1);
}
float farthest(ivec2 place) {
    return texelFetch(levels, place, level - 1).r;
}
#endif

void main() {
    ivec2 own = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(own, imageSize(target)))) {
        return;
    }
    ivec2 last = source_size() - 1;
    ivec2 a = min(2 * own, last), b = min(2 * own + 1, last);
    float least = min(min(farthest(a), farthest(b)),
                      min(farthest(ivec2(a.x, b.y)), farthest(ivec2(b.x, a.y))));
    imageStore(target, own, vec4(least));
}
