// SPDX-License-Identifier: Apache-2.0
// In: a pixel that nothing covers. Out: the sky in its direction.
#include "lib/frame.glsl"
#include "lib/output.glsl"

in vec2 ndc;

void main() {
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    vec3 direction = normalize(near.xyz / near.w - frame.eye);
    vec3 radiance = sky_radiance(direction);
    // The disc, its rim as wide as a pixel; what lies below the horizon is hidden by the land that
    // the terrain has no more of.
    float off = distance(direction, frame.air.to_sun); // as good as the angle, for small ones
    float pixel = 0.7 / frame.focal_px;
    float disc =
        (1.0 - smoothstep(frame.air.disc_radius - pixel, frame.air.disc_radius + pixel, off)) *
        smoothstep(-pixel, pixel, direction.y);
    write_surface(radiance + disc * frame.air.disc, vec3(kTierSky, 0.0, 0.0), vec3(0.0), vec3(0.0));
}
