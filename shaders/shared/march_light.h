// SPDX-License-Identifier: Apache-2.0
// The light of what the far field's march sees: sums over its steps, which the one shading function
// (shared/shading.h) takes. For the march itself, and for the mean of it that sward holds against
// rays through the blades (shells/march_light.h).
#ifndef SWARD_SHARED_MARCH_LIGHT_H
#define SWARD_SHARED_MARCH_LIGHT_H
#include "shared/march.h"
#include "shared/shading.h"

SHARED_BEGIN

// What a step shows.
struct MarchBlades {
    vec3 albedo;
    vec3 tangent; // mean, as bent: shorter than 1 where they differ
    float height; // at rest, 0 ground .. 1 top
    float shown;  // share of the pixel
};

// Mean tangent of blades at height y (m) at rest, as the wind turns them.
SHARED_FN vec3 march_turned(MarchPath path, float y, vec3 rest) {
    vec2 turn = march_turn(path.bend.z * y);
    return vec3(rest.x, 0.0f, rest.z) +
           rest.y * vec3(path.bend.x * turn.x, turn.y, path.bend.y * turn.x);
}

// Mean tangent at rest of a step's blades: as read where a pixel tells blades apart, else the
// layer's.
SHARED_CONST float kFibresFrom = 3.5f, kFibresTo = 4.5f; // mips
SHARED_FN vec3 march_fibre(MARCH_MEDIUM MarchStep taken, vec3 read) {
    return mix(read, vec3(0.0f, medium.layers[taken.layer].x, 0.0f),
               smoothstep(kFibresFrom, kFibresTo, taken.mip));
}

// How much of what a ray crosses it crosses from above, 0..1.
SHARED_FN float march_steepness(MARCH_MEDIUM MarchPlan plan, float fall) {
    vec3 crossed = abs(vec3(medium.edges[0]) * vec3(plan.level.x, fall, plan.level.y));
    return crossed.y / max(crossed.x + crossed.y + crossed.z, 1e-6f);
}

// Albedo as seen so steeply, over the mean that the columns hold.
SHARED_FN vec3 march_tint(MARCH_MEDIUM int layer, float steepness) {
    return vec3(mix(medium.level_tint[layer], medium.steep_tint[layer], steepness));
}

SHARED_FN GrassSums march_nothing() {
    GrassSums sums;
    sums.sunlit = vec3(0.0f, 0.0f, 0.0f);
    sums.skylit = vec3(0.0f, 0.0f, 0.0f);
    sums.sun = 0.0f;
    sums.tangent = vec3(0.0f, 0.0f, 0.0f);
    sums.along = 0.0f;
    return sums;
}

// Adds a step's blades. Until march_radiance `tangent` is a sum, and `along` the share of the pixel
// that has been seen. `slope`: cosine between the ground's normal and the sun.
SHARED_FN void march_gather(SHARED_INOUT(GrassSums) sums, Light light, float slope,
                            MarchBlades blades) {
    float sun = canopy_sun(light, blades.height, slope);
    sums.sunlit = sums.sunlit + blades.albedo * (blades.shown * sun);
    sums.skylit = sums.skylit + blades.albedo * (blades.shown * canopy_sky(light, blades.height));
    sums.sun = sums.sun + blades.shown * sun;
    sums.tangent = sums.tangent + blades.tangent * blades.shown;
    sums.along = sums.along + blades.shown;
}

// Ground under a ray.
struct MarchGround {
    float elevation; // of the ray over the ground's plane (degrees)
    float rise;      // of the ground along the ray, metres a metre
    float slope;     // cosine between its normal and the sun
};

// What stands on such ground: leaning toward the eye, lower or higher than on level ground.
SHARED_FN void march_stand(MARCH_MEDIUM SHARED_INOUT(GrassSums) sums, Light light,
                           MarchGround ground, vec3 to_eye) {
    float at = clamp(ground.elevation / 5.0f, 0.0f, float(kMarchElevations) - 1.001f);
    int row = int(at);
    vec4 known = mix(medium.slopes[row], medium.slopes[row + 1], at - float(row));
    float rise = clamp(2.0f * ground.rise, -2.0f, 2.0f);
    float lean = known.y + (rise > 0.0f ? known.z - known.y : known.y - known.x) * rise;
    float level = max(length(vec2(to_eye.x, to_eye.z)), 1e-4f);
    sums.tangent = sums.tangent + vec3(to_eye.x, 0.0f, to_eye.z) * (lean * sums.along / level);
    float higher = known.w * max(rise, 0.0f);
    float sun = exp(light.sun_extinction * higher / max(ground.slope, 0.12f)); // canopy_sun's
    sums.sunlit = sums.sunlit * sun;
    sums.sun = sums.sun * sun;
    sums.skylit = sums.skylit * exp(light.sky_extinction * higher);
}

// Radiance of the sums toward the eye, times the share of the pixel that they are.
SHARED_FN vec3 march_radiance(MARCH_MEDIUM Light light, GrassSums gathered, vec3 to_eye) {
    GrassSums sums = gathered;
    float evenness = length(sums.tangent);
    sums.along = along_axis(min(evenness / max(gathered.along, 1e-6f), 1.0f));
    sums.tangent = sums.tangent / max(evenness, 1e-6f);
    return shade_sums(medium.gloss, medium.translucency, light, sums, to_eye);
}

SHARED_END
#endif
