// SPDX-License-Identifier: Apache-2.0
// In: multisampled targets. Out: radiance and coverage averaged; depth, tier and the like of the
// first sample.
#include "lib/resolved.glsl"

uniform float weight;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < samples; ++i) {
        sum += texelFetch(scene_color, pixel, i);
    }
    write_first_sample(pixel);
    out_color = sum * (weight / float(samples));
}
