// SPDX-License-Identifier: Apache-2.0
// In: a blade's surface. Out: its light; pixels that its shell image shows already are left to it.
#include "lib/grass_surface.glsl"

in vec3 world;
in vec3 tangent;
in vec3 normal;
in vec2 along;
flat in vec4 own;
flat in vec3 sort; // tint of the ground, species, share of the simulated pose
in vec3 air_added;
in vec3 air_through;

void main() {
    // A triangle seen so nearly edge-on that it has no area in pixels may leave nothing to
    // interpolate: infinities, and NaN of them.
    vec3 values = world + tangent + normal;
    if (!(dot(values, values) < 1e12)) {
        discard;
    }
    if (frame.handover_mode != kHandoverOff &&
        !handover_near(own.x, own.z, frame.handover_band, pixel_threshold(ivec2(gl_FragCoord.xy)),
                       frame.handover_mode)) {
        discard;
    }
    // Where a thin blade covers samples but not the pixel's centre, values are extrapolated, far
    // along the blade.
    vec2 inside = clamp(along, 0.0, 1.0);
    float tier = sort.z > 0.5 ? kTierSimulatedBlade : kTierGroupedBlade;
    write_grass(GrassSample(world, normalize(tangent), normal, own.x, own.y, inside.x, inside.y,
                            own.w, sort.x, tier, int(sort.y), AirLight(air_added, air_through)));
}
