// SPDX-License-Identifier: Apache-2.0
// In: resolved linear radiance. Out: an sRGB picture.
#include "shared/bindings.h"
#include "shared/lod.h"
#include "shared/tone.h"

layout(binding = TEX_RESOLVE_COLOR) uniform sampler2D scene_color;
layout(location = 0) out vec4 out_color;
uniform float exposure;

void main() {
    vec3 radiance = texelFetch(scene_color, ivec2(gl_FragCoord.xy), 0).rgb;
    // An ordered dither of one step: a clear sky has no bands.
    float dither = (pixel_threshold(ivec2(gl_FragCoord.xy)) - 0.5) / 255.0;
    out_color = vec4(srgb_encode(tone_map(radiance * exposure)) + dither, 1.0);
}
