// SPDX-License-Identifier: Apache-2.0
// The last step of every grass fragment, near or far: colour, light, air.
#include "lib/frame.glsl"
#include "lib/output.glsl"

in vec2 sway; // canopy_sway at the blade
#ifdef SURFACE
in float open_sky; // share of the sky that a mesh's surface faces at the blade
#endif

// What a tier knows of a fragment's blade.
struct GrassSample {
    vec3 world;
    vec3 tangent; // unit
    vec3 normal;
    float rank, seed;
    float along;  // place along the blade, 0 root .. 1 tip
    float height; // at rest, over the canopy's
    float slope;  // cosine between ground and sun
    float tint;
    float tier;
    int species;
    AirLight air;
};

void write_grass(GrassSample s) {
    vec3 from_eye = s.world - frame.eye;
    float distance_m = length(from_eye);
    vec3 to_eye = -from_eye / distance_m;
    vec3 albedo = blade_albedo(frame.looks[s.species], vec2(s.rank, s.seed), s.along,
                               colour_detail(frame.blade_width_m * frame.focal_px / distance_m)) *
                  sward_tint(s.tint);
    GrassPoint point = GrassPoint(albedo, s.tangent, s.height, s.slope);
    Light light = light_in_sway(frame.light, sway);
#ifdef SURFACE
    light = light_under(light, open_sky);
#endif
    vec3 radiance =
        shade_grass(frame.looks[s.species], light, point, to_eye) * s.air.through + s.air.added;
    write_surface(radiance, vec3(s.tier, 1.0, s.rank), s.tangent, s.normal);
}
