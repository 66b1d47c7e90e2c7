// SPDX-License-Identifier: Apache-2.0
// The ground from its posts, at any place. Twin: terrain::Surface::height.
#include "shared/bindings.h"
#include "shared/frame.h"
#include "shared/surface.h"

layout(std140, binding = BIND_SURFACE) uniform SurfaceBlock {
    SurfaceParams params;
};
layout(binding = TEX_ELEVATION) uniform sampler2D elevation;

float post(ivec2 at) {
    return texelFetch(elevation, clamp(at, ivec2(0), params.posts - 1), 0).r;
}

// Height above the datum at a true world place, for a grid of `spacing` metres.
float surface_height(vec2 xz, float spacing) {
    vec2 posts = vec2(params.posts - 1);
    vec2 at = clamp(xz / params.post_m + 0.5 * posts, vec2(0.0), posts);
    vec2 base = floor(at);
    vec2 f = at - base;
    ivec2 first = ivec2(base) - 1;
    vec4 rows;
    for (int j = 0; j < 4; ++j) {
        rows[j] = catmull_rom(vec4(post(first + ivec2(0, j)), post(first + ivec2(1, j)),
                                   post(first + ivec2(2, j)), post(first + ivec2(3, j))),
                              f.x);
    }
    return catmull_rom(rows, f.y) + relief_at(xz, params.relief_m, spacing);
}
