// SPDX-License-Identifier: Apache-2.0
// Sun and sky, as the shading function takes them.
#ifndef SWARD_SHARED_LIGHT_H
#define SWARD_SHARED_LIGHT_H
#include "shared/types.h"

SHARED_BEGIN

// Sun and sky, linear. 64 bytes.
struct Light {
    vec3 to_sun;          // unit direction
    float sun_extinction; // of sunlight by the whole canopy at zenith (optical depth)
    vec3 sun;             // irradiance on a plane facing the sun / pi
    float unused_a;       // to 16 bytes
    vec3 zenith;          // the sky's irradiance on level ground / pi
    float sky_extinction; // of skylight by the whole canopy
    vec3 horizon;         // mean sky radiance near the horizon
    float unused_b;
};
#ifdef __cplusplus
static_assert(sizeof(Light) == 64);
#endif

SHARED_END
#endif
