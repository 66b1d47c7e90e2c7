// SPDX-License-Identifier: Apache-2.0
// What a step of the blades' physics is told (J4, J5).
#ifndef SWARD_SHARED_BLADE_STEP_H
#define SWARD_SHARED_BLADE_STEP_H
#include "shared/types.h"

SHARED_BEGIN

// What all blades share in a step. 64 bytes.
struct BladeStep {
    vec3 down; // direction of gravity, unit
    float gravity_mps2;
    vec3 centre;        // anchor-relative place that draws the blades (a planet's middle)
    float centre_mps2;  // its strength
    float memory_loss;  // of eta (1/s)
    float memory_gain;  // eta that a push by the blade's own length brings
    float memory_most;  // its bound
    float centre_share; // of `centre`, 0..1
    float step_s;       // 0: new blades are set up and none moves
    float canopy_m;
    float response; // of the grouped pose, 1 / (m/s), 0: each blade's own
    int run_up;     // 1: blades that nothing has pushed yet are left alone
};
#ifdef __cplusplus
static_assert(sizeof(BladeStep) == 64);
#endif

SHARED_END
#endif
