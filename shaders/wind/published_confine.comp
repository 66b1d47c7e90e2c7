// SPDX-License-Identifier: Apache-2.0
// The published scheme (W2), for the bench alone: vorticity confinement f = eps h (N x omega) added
// in place.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_VORTICITY) readonly buffer WindVorticity {
    float vorticity[];
};

float spin(ivec2 corner) {
    return vorticity[near_index(corner)];
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    float omega = spin(c);
    vec2 slope = vec2(abs(spin(c + ivec2(1, 0))) - abs(spin(c - ivec2(1, 0))),
                      abs(spin(c + ivec2(0, 1))) - abs(spin(c - ivec2(0, 1))));
    vec2 n = slope / (length(slope) + 1e-9);
    float push = grid.confinement * grid.cell_m * grid.step_s * omega;
    wind_u[own] = (wind_u[own] + push * n.y) * grid.kept;
    wind_v[own] = (wind_v[own] - push * n.x) * grid.kept;
}
