// SPDX-License-Identifier: Apache-2.0
// In: velocities after the forces, faces of solids, prescribed inflow, the last step's pressure as
// a first guess. Out: what divergence (times the cell's width) that guess leaves: the residual that
// the solver begins with.
#include "wind/faces.glsl"
#include "wind/poisson.glsl"
#include "wind/solids.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRESSURE) readonly buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_DRAWN_INFLOW) readonly buffer WindInflow {
    float wind_inflow[];
};

void main() {
    ivec2 inner = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(inner, ivec2(grid.inner_cells)))) {
        return;
    }
    ivec2 c = inner + grid.inner_first;
    int own = cell_index(c);
    int west = near_index(c - ivec2(1, 0)), east = near_index(c + ivec2(1, 0));
    int north = near_index(c - ivec2(0, 1)), south = near_index(c + ivec2(0, 1));
    vec4 flow = vec4(sane(wind_u[own]), sane(wind_u[east]), sane(wind_v[own]), sane(wind_v[south]));
    vec4 w = unpack_weights(weights[own]);
    if (grid.has_solids != 0 && min(min(w.x, w.y), min(w.z, w.w)) == 0.0) {
        flow = vec4(w.x == 0.0 ? solid_velocity_between(own, west).x : flow.x,
                    w.y == 0.0 ? solid_velocity_between(own, east).x : flow.y,
                    w.z == 0.0 ? solid_velocity_between(own, north).y : flow.z,
                    w.w == 0.0 ? solid_velocity_between(own, south).y : flow.w);
    }
    vec4 around = vec4(beyond(0, inner - ivec2(1, 0)) ? 0.0 : pressure[west],
                       beyond(0, inner + ivec2(1, 0)) ? 0.0 : pressure[east],
                       beyond(0, inner - ivec2(0, 1)) ? 0.0 : pressure[north],
                       beyond(0, inner + ivec2(0, 1)) ? 0.0 : pressure[south]);
    float taken = dot(w, around - pressure[own]);
    rhs[own] = w != vec4(0.0) ? flow.y - flow.x + flow.w - flow.z -
                                    sane(wind_inflow[own] * grid.cell_m) - taken
                              : 0.0;
}
