// SPDX-License-Identifier: Apache-2.0
// The published scheme (W2), for the bench alone: divergence times the cell's width.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_RHS) writeonly buffer WindRhs {
    float rhs[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    rhs[own] = wind_u[near_index(c + ivec2(1, 0))] - wind_u[own] +
               wind_v[near_index(c + ivec2(0, 1))] - wind_v[own];
}
