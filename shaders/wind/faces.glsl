// SPDX-License-Identifier: Apache-2.0
// Velocities on faces, and what solids make of them.
#include "wind/grid.glsl"

layout(std430, binding = BIND_WIND_U) buffer WindU {
    float wind_u[];
};
layout(std430, binding = BIND_WIND_V) buffer WindV {
    float wind_v[];
};
