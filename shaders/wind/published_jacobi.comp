// SPDX-License-Identifier: Apache-2.0
// The published scheme (W2), for the bench alone: one Jacobi sweep of the pressure; 0 at the rim.
#include "wind/grid.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_RHS) readonly buffer WindRhs {
    float rhs[];
};
layout(std430, binding = BIND_WIND_PRESSURE) readonly buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_NEXT_PRESSURE) writeonly buffer WindNextPressure {
    float next_pressure[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(lessThan(c, ivec2(1))) || any(greaterThanEqual(c, ivec2(grid.cells - 1)))) {
        return;
    }
    int own = cell_index(c);
    next_pressure[own] =
        0.25 *
        (pressure[near_index(c - ivec2(1, 0))] + pressure[near_index(c + ivec2(1, 0))] +
         pressure[near_index(c - ivec2(0, 1))] + pressure[near_index(c + ivec2(0, 1))] - rhs[own]);
}
