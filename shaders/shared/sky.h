// SPDX-License-Identifier: Apache-2.0
// Sky and aerial perspective, from the frame's air. GLSL: `frame.air` must be declared before
// (lib/frame.glsl).
#ifndef SWARD_SHARED_SKY_H
#define SWARD_SHARED_SKY_H
#include "shared/air.h"

#ifdef __cplusplus
#define AIR_OF_FRAME const Air &air,
#define AIR air
#else
#define AIR_OF_FRAME
#define AIR frame.air
#endif

SHARED_BEGIN

// Amounts of a row: radiance towards `way` (unit).
SHARED_FN vec3 sky_in_row(AIR_OF_FRAME SkyRow row, vec3 way) {
    float c = dot(way, AIR.to_sun);
    float turn = (way.x * AIR.level_sun.x + way.z * AIR.level_sun.z) *
                 inversesqrt(max(way.x * way.x + way.z * way.z, 1e-8f));
    vec3 molecules = vec3(row.molecules) + turn * vec3(row.molecules_turn);
    vec3 haze = vec3(row.haze) + turn * vec3(row.haze_turn);
    vec3 many = vec3(row.many) + turn * vec3(row.many_turn);
    return max(molecules * phase_of_molecules(c) + haze * phase_of_haze(c) + many,
               vec3(0.0f, 0.0f, 0.0f));
}

SHARED_FN SkyRow sky_blend(SkyRow a, SkyRow b, SkyRow c, vec3 w) {
    SkyRow row;
    row.molecules = w.x * a.molecules + w.y * b.molecules + w.z * c.molecules;
    row.molecules_turn = w.x * a.molecules_turn + w.y * b.molecules_turn + w.z * c.molecules_turn;
    row.haze = w.x * a.haze + w.y * b.haze + w.z * c.haze;
    row.haze_turn = w.x * a.haze_turn + w.y * b.haze_turn + w.z * c.haze_turn;
    row.many = w.x * a.many + w.y * b.many + w.z * c.many;
    row.many_turn = w.x * a.many_turn + w.y * b.many_turn + w.z * c.many_turn;
    return row;
}

// Radiance of the sky in a unit direction, without the sun's disc; below the horizon that of the
// horizon. Rows are blended by quadratic B-splines, whose slope has no steps that would show as
// bands.
SHARED_FN vec3 sky_radiance(AIR_OF_FRAME vec3 direction) {
    float at = sqrt(clamp(direction.y, 0.0f, 1.0f)) * float(kSkyRows - 1);
    int row = int(floor(at + 0.5f));
    float t = at - float(row);
    vec3 weights =
        vec3(0.5f * (0.5f - t) * (0.5f - t), 0.75f - t * t, 0.5f * (0.5f + t) * (0.5f + t));
    SkyRow blend = sky_blend(AIR.sky[max(row - 1, 0)], AIR.sky[row],
                             AIR.sky[min(row + 1, kSkyRows - 1)], weights);
#ifdef __cplusplus
    return sky_in_row(air, blend, direction);
#else
    return sky_in_row(blend, direction);
#endif
}

// Air between the eye and a surface (offset from_eye, m): Beer's law along the way through
// molecules and haze that thin out with height, and towards the horizon's light in that direction,
// which is what a level way without end through such air shows. Smooth: grass takes it at its
// vertices.
SHARED_FN AirLight haze_of(AIR_OF_FRAME vec3 from_eye) {
    float far_m = length(from_eye);
    vec3 depth = vec3(AIR.molecules) * thinning(from_eye.y * AIR.molecules_per_m) +
                 vec3(AIR.haze) * thinning(from_eye.y * AIR.haze_per_m);
    AirLight light;
    light.through = exp(-depth * far_m);
    vec3 way = from_eye / max(far_m, 1e-6f);
#ifdef __cplusplus
    vec3 horizon = sky_in_row(air, AIR.sky[0], way);
#else
    vec3 horizon = sky_in_row(AIR.sky[0], way);
#endif
    light.added = horizon * (1.0f - light.through);
    return light;
}

SHARED_END
#undef AIR_OF_FRAME
#undef AIR
#endif
