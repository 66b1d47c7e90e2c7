// SPDX-License-Identifier: Apache-2.0
// In: the ground. Out: soil where grass is drawn over it; past the shells, the canopy's far
// appearance, handed over by the same share as the last shells and slices.
#include "lib/ground.glsl"
#include "lib/land_ground.glsl"
#include "lib/output.glsl"
#include "lib/sway.glsl"
#include "shared/sward.h"

layout(binding = TEX_FAR_APPEARANCE) uniform sampler2DArray far_appearance;

in vec3 world;
in vec2 sway;
in float gust;

// Reflectance of the ground, as a pixel `width` metres wide shows it: rock where no grass will
// grow, else soil, moss and litter. A landcover says itself what lies where.
vec3 soil_colour(vec2 xz, Ground ground, float width) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    float tint = sward_patches(xz, anchor, ground.tint, width);
    float earth = smoothstep(0.0, 0.4, ground.density);
    vec3 floor_here = floor_at(xz, anchor, vec2(frame.soil_cover, tint), width);
    vec3 bare = mix(frame.rock.rgb, frame.soil, has_land() ? 1.0 : earth) *
                (floor_here.x * mix(0.75, 1.25, tint));
    vec3 cover = mix(frame.moss.rgb, frame.litter.rgb, floor_here.z) * mix(1.0, floor_here.x, 0.5);
    return mix(bare, cover, floor_here.y * earth);
}

// The whole canopy by the sun's azimuth from the eye's and the elevation of the view.
struct Canopy {
    vec4 sun; // radiance by sunlight on flat ground; coverage
    vec4 sky; // radiance by skylight; mean height of what is seen
};

Canopy canopy_in_wind(vec2 uv, float wind) {
    return Canopy(textureLod(far_appearance, vec3(uv, 2.0 * wind), 0.0),
                  textureLod(far_appearance, vec3(uv, 2.0 * wind + 1.0), 0.0));
}

Canopy canopy_from_afar(vec3 to_eye, vec3 normal) {
    vec2 eye = normalize(to_eye.xz + vec2(1e-5, 0.0));
    vec2 sun = frame.light.to_sun.xz + vec2(1e-5, 0.0);
    float azimuth = atan(eye.x * sun.y - eye.y * sun.x, dot(eye, sun)) / (2.0 * kPi);
    float elevation = clamp(dot(to_eye, normal), 0.0, 1.0);
    vec2 size = vec2(textureSize(far_appearance, 0));
    vec2 uv = vec2(azimuth + 0.5 / size.x, (elevation * (size.y - 1.0) + 0.5) / size.y);
    float calmer = min(floor(gust), float(kFarWinds - 2));
    Canopy low = canopy_in_wind(uv, calmer);
    Canopy high = canopy_in_wind(uv, calmer + 1.0);
    return Canopy(mix(low.sun, high.sun, gust - calmer), mix(low.sky, high.sky, gust - calmer));
}

void main() {
    vec3 from_eye = world - frame.eye;
    float distance_m = length(from_eye);
    vec3 to_eye = -from_eye / distance_m;
    Ground ground = ground_surface(world.xz);

    float shade = sway.y; // of the grass over it
    if (has_tracks()) {   // which are finer than the vertices
        shade =
            sway_over(world, wind_at(world.xz), track_at(world.xz, distance_m / frame.focal_px)).y;
    }
    float width =
        distance_m / frame.focal_px * max(0.5 / max(dot(to_eye, ground.normal), 0.05), 1.0);
    Grounds grounds = grounds_at(world.xz, width);
    vec3 soil_albedo = soil_colour(world.xz, ground, width);
    if (has_land()) {
        soil_albedo = ground_colour(soil_albedo, grounds, world.xz, ground.tint, width);
    }
    float sun = sun_seen(world.xz, 0.0);
    vec3 soil = shade_soil(light_in_sway(frame.light, vec2(sun, shade)), soil_albedo, ground.normal,
                           ground.density);
    if (grounds.water > 0.0) {
        soil = mix(soil, water_radiance(world.xz, to_eye, width), grounds.water);
    }

    float left_shells = 1.0 - handover_share(distance(world, frame.lod_eye),
                                             frame.far_bands[frame.far_levels - 1].outgoing);
    left_shells *= frame.ground_takes_over; // 0 where no tier hands its blades to the ground
                                            // (--tiers blades, reference)
    Canopy canopy = Canopy(vec4(0.0), vec4(0.0));
    if (left_shells > 0.0) {
        canopy = canopy_from_afar(to_eye, ground.normal);
    }
    float coverage = 1.0 - pow(1.0 - min(canopy.sun.a, 0.999), ground.density * left_shells);
    // The table is of flat ground.
    float slope = dot(ground.normal, frame.light.to_sun);
    float relight = canopy_sun(frame.light, canopy.sky.a, slope) /
                    max(canopy_sun(frame.light, canopy.sky.a, frame.light.to_sun.y), 1e-3);
    vec3 grass = canopy.sun.rgb * (relight * sun) + canopy.sky.rgb;
    grass *= sward_tint(sward_patches(world.xz, ivec2(frame.anchor_x, frame.anchor_z), ground.tint,
                                      distance_m / frame.focal_px));

    AirLight air = haze_of(from_eye);
    vec3 radiance = mix(soil, grass, coverage) * air.through + air.added;
    write_surface(radiance, vec3(kTierGround, coverage, 0.0), vec3(0.0), ground.normal);
}
