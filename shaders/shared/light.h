// SPDX-License-Identifier: Apache-2.0
// Sun, sky and air, as the shading function takes them.
#ifndef SWARD_SHARED_LIGHT_H
#define SWARD_SHARED_LIGHT_H
#include "shared/types.h"

SHARED_BEGIN

// Sun and sky, linear. 64 bytes.
struct Light {
    vec3 to_sun;          // unit direction
    float sun_extinction; // of sunlight by the whole canopy at zenith (optical depth)
    vec3 sun;             // irradiance on a plane facing the sun / pi
    float haze_per_m;
    vec3 zenith;          // sky radiance overhead
    float sky_extinction; // of skylight by the whole canopy
    vec3 horizon;         // sky radiance there
    float exposure;
};
#ifdef __cplusplus
static_assert(sizeof(Light) == 64);
#endif

SHARED_END
#endif
