// SPDX-License-Identifier: Apache-2.0
// In: what a host has drawn, its depth as its own matrix has it. Out: the same as an object of the
// scene, in every sample of the pixel.
#include "lib/frame.glsl"
#include "lib/output.glsl"

layout(binding = TEX_RESOLVE_COLOR) uniform sampler2D host_color;
layout(binding = TEX_RESOLVE_DEPTH) uniform sampler2D host_scene_depth;
uniform vec4 host_depth; // the host's depth is x + y over the distance along the axis; 1 where
                         // there is a colour

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(host_scene_depth, pixel, 0).r;
    float nothing =
        host_depth.y > 0.0 ? 0.0 : 1.0; // what a host clears to, whether it has a far plane or none
    if (depth == nothing) {
        discard;
    }
    gl_FragDepth = frame.near_m * (depth - host_depth.x) / host_depth.y;
    vec3 radiance = host_depth.z > 0.5 ? texelFetch(host_color, pixel, 0).rgb : vec3(0.0);
    write_surface(radiance, vec3(kTierObject, 0.0, 0.0), vec3(0.0), vec3(0.0));
}
