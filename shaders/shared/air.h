// SPDX-License-Identifier: Apache-2.0
// The air of a frame: what the renderer has worked out of the atmosphere (src/render/atmosphere.h)
// for its sun. shared/sky.h reads it.
#ifndef SWARD_SHARED_AIR_H
#define SWARD_SHARED_AIR_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kSkyRows =
    16; // elevations; row i at the sine (i / (kSkyRows - 1))^2, so that most lie at the horizon

// Sky radiance at one elevation over the phase function of what scatters it: `x` + `x_turn` times
// the cosine of the azimuth from the sun.
struct SkyRow {
    vec4 molecules, molecules_turn;
    vec4 haze, haze_turn;
    vec4 many, many_turn; // scattered more than once: radiance as it is
};

struct Air {
    vec3 to_sun;           // unit
    float molecules_per_m; // 1 over the scale height of molecules
    vec3 level_sun;        // unit, along x and z of to_sun
    float haze_per_m;      // as molecules_per_m, of haze
    vec4 molecules;        // rgb extinction at the eye (1/m)
    vec4 haze;             // likewise
    vec3 disc;             // radiance of the sun's disc
    float disc_radius;     // radians
    SkyRow sky[kSkyRows];
};
#ifdef __cplusplus
static_assert(sizeof(Air) == 80 + 96 * kSkyRows);
#endif

// What the air between the eye and a surface does to its light.
struct AirLight {
    vec3 added;
    vec3 through; // share of the surface's
};

// Phase functions over the sphere, mean 1 / (4 pi); c: cosine of the angle that light turns by.
SHARED_FN float phase_of_molecules(float c) {
    return 3.0f / (16.0f * kPi) * (1.0f + c * c);
}

// Cornette and Shanks 1992.
SHARED_CONST float kHazeForward = 0.76f; // mean cosine g of continental aerosol
SHARED_FN float phase_of_haze(float c) {
    float g = kHazeForward;
    float d = 1.0f + g * g - 2.0f * g * c;
    return 3.0f / (8.0f * kPi) * (1.0f - g * g) / (2.0f + g * g) * (1.0f + c * c) / (d * sqrt(d));
}

// Mean of exp(-h / H) along a way that climbs by `rise` = height / H, from h = 0: (1 - exp(-rise))
// / rise.
SHARED_FN float thinning(float rise) {
    float x = clamp(rise, -20.0f, 80.0f);
    return abs(x) < 1e-3f ? 1.0f - 0.5f * x : (1.0f - exp(-x)) / x;
}

// Shadow of the land, from the two heights over the ground (m) where the sun's disc begins to be
// seen and is wholly seen: share of the disc that a point `above` the ground (m) sees.
SHARED_FN float sun_share(vec2 seen_from, float above) {
    return smoothstep(seen_from.x, seen_from.y, above);
}

SHARED_END
#endif
