// SPDX-License-Identifier: Apache-2.0
// In: resolved linear radiance. Out: an sRGB picture.
#include "shared/bindings.h"
#include "shared/tone.h"

layout(binding = TEX_RESOLVE_COLOR) uniform sampler2D scene_color;
layout(location = 0) out vec4 out_color;
uniform float exposure;

void main() {
    vec3 radiance = texelFetch(scene_color, ivec2(gl_FragCoord.xy), 0).rgb;
    out_color = vec4(srgb_encode(tone_map(radiance * exposure)), 1.0);
}
