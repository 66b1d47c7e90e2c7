// SPDX-License-Identifier: Apache-2.0
// In: a pixel that nothing covers. Out: the sky in its direction.
#include "lib/frame.glsl"
#include "lib/output.glsl"

in vec2 ndc;

void main() {
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    vec3 direction = normalize(near.xyz / near.w - frame.eye);
    // Below the horizon there is only the haze at the end of the terrain.
    vec3 radiance = sky_radiance(frame.light, normalize(vec3(direction.x, max(direction.y, 0.02), direction.z)));
    float disc = smoothstep(0.99990, 0.99996, dot(direction, frame.light.to_sun));
    write_surface(radiance + disc * 30.0 * frame.light.sun, vec3(kTierSky, 0.0, 0.0), vec3(0.0), vec3(0.0));
}
