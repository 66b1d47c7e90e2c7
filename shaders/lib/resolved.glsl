// SPDX-License-Identifier: Apache-2.0
// The multisampled scene, and the picture that it is resolved into.
#include "lib/frame.glsl"

layout(binding = TEX_RESOLVE_COLOR) uniform sampler2DMS scene_color;
layout(binding = TEX_RESOLVE_DEPTH) uniform sampler2DMS scene_depth;
#ifdef AOV
layout(binding = TEX_RESOLVE_DATA) uniform sampler2DMS scene_data;
layout(binding = TEX_RESOLVE_TANGENT) uniform sampler2DMS scene_tangent;
layout(binding = TEX_RESOLVE_NORMAL) uniform sampler2DMS scene_normal;
layout(location = OUT_TANGENT) out vec4 out_tangent;
layout(location = OUT_NORMAL) out vec4 out_normal;
#endif
layout(location = OUT_COLOR) out vec4 out_color;
layout(location =
           OUT_DATA) out vec4 out_data; // depth along the view axis (m, 0 at infinity), tier, rank
uniform int samples;

// Distance along the view axis, from reversed depth.
float axial_distance(float depth) {
    return depth > 0.0 ? frame.near_m / depth : 0.0;
}

// All but colour is the first sample's: a mean of tiers is no tier.
void write_first_sample(ivec2 pixel) {
    out_data = vec4(axial_distance(texelFetch(scene_depth, pixel, 0).r), 0.0, 0.0, 0.0);
#ifdef AOV
    vec4 data = texelFetch(scene_data, pixel, 0);
    out_data.yz = data.xz;
    out_tangent = texelFetch(scene_tangent, pixel, 0);
    out_normal = texelFetch(scene_normal, pixel, 0);
#endif
}
