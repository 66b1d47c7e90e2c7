// SPDX-License-Identifier: Apache-2.0
// The published scheme (W2), for the bench alone: the pressure's gradient taken off.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRESSURE) readonly buffer WindPressure {
    float pressure[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    float here = pressure[own];
    wind_u[own] -= here - pressure[near_index(c - ivec2(1, 0))];
    wind_v[own] -= here - pressure[near_index(c - ivec2(0, 1))];
}
