// SPDX-License-Identifier: Apache-2.0
// In: the ground. Out: soil where grass is drawn over it; past the shells, the canopy's far appearance, handed over by the
// same share as the last shells and slices.
#include "lib/ground.glsl"
#include "lib/output.glsl"

layout(binding = TEX_FAR_APPEARANCE) uniform sampler2D far_appearance;

in vec3 world;
in vec2 sway;

// Radiance (rgb) and coverage (a) of the whole canopy by azimuth from the sun and elevation of the view.
vec4 canopy_from_afar(vec3 to_eye, vec3 normal) {
    vec2 flat_eye = normalize(to_eye.xz + vec2(1e-5, 0.0));
    vec2 flat_sun = normalize(frame.light.to_sun.xz + vec2(1e-5, 0.0));
    float azimuth = atan(length(vec2(dot(flat_eye, vec2(-flat_sun.y, flat_sun.x)))), dot(flat_eye, flat_sun)) / kPi;
    float elevation = clamp(dot(to_eye, normal), 0.0, 1.0);
    vec2 size = vec2(textureSize(far_appearance, 0));
    vec2 uv = (vec2(azimuth, elevation) * (size - 1.0) + 0.5) / size;
    return textureLod(far_appearance, uv, 0.0);
}

void main() {
    vec3 from_eye = world - frame.eye.xyz;
    float distance_m = length(from_eye);
    vec3 to_eye = -from_eye / distance_m;
    Ground ground = ground_surface(world.xz);

    float variation = mix(0.75, 1.25, ground.tint);
    vec3 soil_albedo = mix(frame.ground_colours[1].rgb, frame.ground_colours[0].rgb, smoothstep(0.0, 0.4, ground.density)) * variation;
    vec3 soil = shade_soil(light_in_sway(frame.light, vec2(1.0, sway.y)), soil_albedo, ground.normal, ground.density);

    float left_shells = 1.0 - handover_share(distance(world, frame.lod_eye.xyz), frame.far_bands[frame.patch_tile.w - 1].zw);
    left_shells *= frame.grass.z; // 0 where no tier hands its blades to the ground (--tiers blades, reference)
    vec4 canopy = canopy_from_afar(to_eye, ground.normal);
    float coverage = 1.0 - pow(1.0 - min(canopy.a, 0.999), ground.density * left_shells);
    float slope = dot(ground.normal, frame.light.to_sun.xyz);
    float relight = canopy_sun(frame.light, 0.6, slope) / max(canopy_sun(frame.light, 0.6, frame.light.to_sun.y), 1e-3);
    vec3 grass = canopy.rgb * mix(1.0, relight, 0.8) * sward_tint(ground.tint);

    vec4 haze = haze_of(frame.light, from_eye);
    vec3 radiance = mix(soil, grass, coverage) * haze.a + haze.rgb;
    write_surface(radiance, vec3(kTierGround, coverage, 0.0), vec3(0.0), ground.normal);
}
