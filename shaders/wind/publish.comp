// SPDX-License-Identifier: Apache-2.0
// In: velocities of a finished step. Out: velocities at cell centres, the latest beside the
// previous, for wind_at().
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_CELLS) buffer WindCells {
    vec4 cells[];
};
layout(location = 0) uniform int fresh; // 1: the first state, which has no other before it

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    vec2 latest = 0.5 * vec2(wind_u[own] + wind_u[near_index(c + ivec2(1, 0))],
                             wind_v[own] + wind_v[near_index(c + ivec2(0, 1))]);
    cells[own] = vec4(fresh != 0 ? latest : cells[own].zw, latest);
}
