// SPDX-License-Identifier: Apache-2.0
// In: velocities of the ambient tile. Out: their mean x, z and mean square, summed in one order.
#include "wind/faces.glsl"

layout(local_size_x = WIND_SOLVE_GROUP) in;
layout(std430, binding = BIND_WIND_TOTALS) writeonly buffer WindTotals {
    float totals[];
};

shared vec3 sums[WIND_SOLVE_GROUP];

void main() {
    int own = int(gl_LocalInvocationIndex), count = grid.cells * grid.cells;
    vec3 sum = vec3(0.0);
    for (int i = own; i < count; i += WIND_SOLVE_GROUP) {
        float u = wind_u[i], v = wind_v[i];
        sum += vec3(u, v, u * u + v * v);
    }
    sums[own] = sum;
    barrier();
    for (int half_count = WIND_SOLVE_GROUP / 2; half_count > 0; half_count /= 2) {
        if (own < half_count) {
            sums[own] += sums[own + half_count];
        }
        barrier();
    }
    if (own < 3) {
        totals[own] = sums[0][own] / float(count);
    }
}
