// SPDX-License-Identifier: Apache-2.0
// In: direction, product, alpha. Out: pressure a step further along the direction, and the residual
// that is left.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRESSURE) buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_NEXT_DIRECTION) readonly buffer WindNextDirection {
    float next_direction[];
};
layout(std430, binding = BIND_WIND_PRODUCT) readonly buffer WindProduct {
    float product[];
};
layout(std430, binding = BIND_WIND_SCALARS) readonly buffer WindScalars {
    float scalars[];
};

// More than any flow can need; a region that walls close and a moving solid squeezes has no
// solution, and would climb for ever.
const float kMostPressure = 1e6;

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, ivec2(side_of(0))))) {
        return;
    }
    int own = element(0, c);
    float next = pressure[own] + scalars[0] * next_direction[own];
    pressure[own] = abs(next) < kMostPressure ? next : 0.0;
    rhs[own] -= scalars[0] * product[own];
}
