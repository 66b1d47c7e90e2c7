// SPDX-License-Identifier: Apache-2.0
// In: the resolved picture. Out: its radiance, and its depth as the host's matrix has it, into the
// host's textures.
#include "shared/bindings.h"

layout(binding = TEX_RESOLVE_COLOR) uniform sampler2D resolved_color;
layout(binding = TEX_RESOLVE_DATA) uniform sampler2D resolved_data;
layout(location = 0) out vec4 out_color;
uniform vec4 host_depth; // as host_scene.frag's; z, w: unused

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_color = vec4(texelFetch(resolved_color, pixel, 0).rgb, 1.0);
    float distance_m = texelFetch(resolved_data, pixel, 0).x; // along the axis, 0 at infinity
    float nothing = host_depth.y > 0.0 ? 0.0 : 1.0;
    gl_FragDepth = distance_m > 0.0 ? host_depth.x + host_depth.y / distance_m : nothing;
}
