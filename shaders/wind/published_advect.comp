// SPDX-License-Identifier: Apache-2.0
// The published scheme (W2), for the bench alone: semi-Lagrangian advection, one step back in a
// straight line, bilinear.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_U_NEXT) writeonly buffer WindUNext {
    float u_next[];
};
layout(std430, binding = BIND_WIND_V_NEXT) writeonly buffer WindVNext {
    float v_next[];
};

#define BILINEAR_AT(name, field)                                                                   \
    float name(vec2 place) {                                                                       \
        vec2 low = floor(place), within = place - low;                                             \
        int x0 = stored_column(near_cell(int(low.x))),                                             \
            x1 = stored_column(near_cell(int(low.x) + 1));                                         \
        int y0 = stored_row(near_cell(int(low.y))) * grid.cells,                                   \
            y1 = stored_row(near_cell(int(low.y) + 1)) * grid.cells;                               \
        return mix(mix(field[y0 + x0], field[y0 + x1], within.x),                                  \
                   mix(field[y1 + x0], field[y1 + x1], within.x), within.y);                       \
    }
BILINEAR_AT(u_at, wind_u)
BILINEAR_AT(v_at, wind_v)

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    int west = near_index(c - ivec2(1, 0)), east = near_index(c + ivec2(1, 0));
    int north = near_index(c - ivec2(0, 1)), south = near_index(c + ivec2(0, 1));
    vec2 at_u = vec2(wind_u[own], 0.25 * (wind_v[own] + wind_v[west] + wind_v[south] +
                                          wind_v[near_index(c + ivec2(-1, 1))]));
    vec2 at_v = vec2(
        0.25 * (wind_u[own] + wind_u[east] + wind_u[north] + wind_u[near_index(c + ivec2(1, -1))]),
        wind_v[own]);
    float n = float(grid.cells);
    u_next[own] = u_at(clamp(vec2(c) - at_u * grid.step_per_m, vec2(0.0), vec2(n)));
    v_next[own] = v_at(clamp(vec2(c) - at_v * grid.step_per_m, vec2(0.0), vec2(n)));
}
