// SPDX-License-Identifier: Apache-2.0
// In: velocities. Out: vorticity dv/dx - du/dz at each cell's north-west corner (W2).
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_VORTICITY) writeonly buffer WindVorticity {
    float vorticity[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    vorticity[own] = (wind_v[own] - wind_v[near_index(c - ivec2(1, 0))] - wind_u[own] +
                      wind_u[near_index(c - ivec2(0, 1))]) *
                     grid.per_m;
}
