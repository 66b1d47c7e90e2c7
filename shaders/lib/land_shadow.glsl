// SPDX-License-Identifier: Apache-2.0
// Shadow of the land: share of the sun's disc that is seen over it. Twin: terrain::SunSweep, read
// between its posts.
#include "lib/frame.glsl"

layout(binding = TEX_LAND_SHADOW) uniform sampler2D land_shadow;

// From so high over the ground (m) at a place.
float sun_seen(vec2 xz, float above) {
    if (frame.has_shadow < 0.5) {
        return 1.0;
    }
    return sun_share(textureLod(land_shadow, xz * frame.shadow_per_m + frame.shadow_offset, 0.0).rg,
                     above);
}
