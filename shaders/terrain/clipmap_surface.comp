// SPDX-License-Identifier: Apache-2.0
// In: a clipmap level's heights. Out: its normal, grass density by the slope, and tint. Posts at
// the window's rim take wrapped neighbours; nothing reads them (ground.glsl leaves a level 8 posts
// before).
#include "shared/bindings.h"
#include "shared/frame.h"
#include "shared/surface.h"

layout(local_size_x = CLIP_GROUP, local_size_y = CLIP_GROUP) in;
layout(std140, binding = BIND_SURFACE) uniform SurfaceBlock {
    SurfaceParams params;
};
layout(binding = TEX_CLIP_HEIGHT) uniform sampler2DArray heights;
layout(rgba8, binding = 0) uniform writeonly image2D surfaces;

float height_at(ivec2 texel) {
    return texelFetch(heights, ivec3(texel & (kClipCells - 1), params.level), 0).r;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 world = params.first + ((texel - params.first) & (kClipCells - 1));
    vec2 xz = vec2(world) * params.spacing_m;
    vec2 slope = vec2(height_at(texel + ivec2(1, 0)) - height_at(texel - ivec2(1, 0)),
                      height_at(texel + ivec2(0, 1)) - height_at(texel - ivec2(0, 1))) /
                 (2.0 * params.spacing_m);
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    float density = slope_density(normal, xz);
    float tint = surface_tint(xz, params.spacing_m);
    imageStore(surfaces, texel, vec4((normal.xz * 127.0 + 128.0) / 255.0, density, tint));
}
