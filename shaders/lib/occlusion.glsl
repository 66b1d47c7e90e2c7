// SPDX-License-Identifier: Apache-2.0
// Is something behind the opaque scene, by its depth pyramid (J7)?
#include "lib/frame.glsl"

layout(binding = TEX_DEPTH_PYRAMID) uniform sampler2D depth_pyramid;

// True where every pixel that a sphere could show in holds something nearer than its nearest point.
// What passes the near plane or the picture's rim counts as seen: other tests are for that.
bool occluded(vec3 centre, float radius) {
    vec4 clip = frame.clip_from_world * vec4(centre, 1.0);
    float nearest = clip.w - radius;
    if (nearest < frame.near_m) {
        return false;
    }
    vec2 picture = vec2(frame.picture_px);
    vec2 middle = (0.5 + 0.5 * clip.xy / clip.w) * picture;
    // Off the axis a sphere's image is an ellipse: as long as this at most, by the cosine to the
    // axis.
    vec3 to = centre - frame.eye;
    float reach = radius * frame.focal_px / nearest * length(to) / clip.w + 1.0;
    vec2 low = middle - reach, high = middle + reach;
    if (any(lessThan(low, vec2(0.0))) || any(greaterThanEqual(high, picture))) {
        return false;
    }
    // The level whose texels are as wide as the sphere: it lies in four of them at most.
    int level = clamp(int(ceil(log2(max(reach, 1.0)))), 0, textureQueryLevels(depth_pyramid) - 1);
    ivec2 first = ivec2(low) >> (level + 1), last = ivec2(high) >> (level + 1);
    float farthest = min(
        min(texelFetch(depth_pyramid, first, level).r, texelFetch(depth_pyramid, last, level).r),
        min(texelFetch(depth_pyramid, ivec2(first.x, last.y), level).r,
            texelFetch(depth_pyramid, ivec2(last.x, first.y), level).r));
    return frame.near_m / nearest < farthest;
}
