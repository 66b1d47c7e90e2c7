// SPDX-License-Identifier: Apache-2.0
// In: velocities after the forces, pressure. Out: velocities without divergence, on the faces of
// solids exactly the solid's; and those that the next advection carries, with half of this pressure
// step taken off once more.
#include "wind/faces.glsl"
#include "wind/poisson.glsl"
#include "wind/solids.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRESSURE) readonly buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_U_CARRIED) writeonly buffer WindUCarried {
    float u_carried[];
};
layout(std430, binding = BIND_WIND_V_CARRIED) writeonly buffer WindVCarried {
    float v_carried[];
};

// Pressure at a solved cell, 0 in the rim.
float pressure_of(ivec2 c) {
    ivec2 inner = held(0, c - grid.inner_first);
    float value = pressure[element(0, inner)];
    return beyond(0, c - grid.inner_first) ? 0.0 : value;
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    int west = near_index(c - ivec2(1, 0)), north = near_index(c - ivec2(0, 1));
    ivec2 inner = c - grid.inner_first;
    bvec2 within = bvec2(inner.x >= 0 && inner.x < grid.inner_cells,
                         inner.y >= 0 && inner.y < grid.inner_cells);
    float u = sane(wind_u[own]), v = sane(wind_v[own]);
    float here = pressure_of(c);
    vec2 half_step = vec2(0.0);
    if (within.y && inner.x >= 0 && inner.x <= grid.inner_cells) {
        float w = within.x ? unpack_weights(weights[own]).x : unpack_weights(weights[west]).y;
        float taken = w * (here - pressure_of(c - ivec2(1, 0)));
        u = w > 0.0 ? sane(u - taken) : solid_velocity_between(own, west).x;
        half_step.x = within.x ? 0.5 * taken : 0.0;
    }
    if (within.x && inner.y >= 0 && inner.y <= grid.inner_cells) {
        float w = within.y ? unpack_weights(weights[own]).z : unpack_weights(weights[north]).w;
        float taken = w * (here - pressure_of(c - ivec2(0, 1)));
        v = w > 0.0 ? sane(v - taken) : solid_velocity_between(own, north).y;
        half_step.y = within.y ? 0.5 * taken : 0.0;
    }
    wind_u[own] = u;
    wind_v[own] = v;
    u_carried[own] = sane(u - half_step.x);
    v_carried[own] = sane(v - half_step.y);
}
