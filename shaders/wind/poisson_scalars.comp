// SPDX-License-Identifier: Apache-2.0
// In: sums of workgroups. Out: conjugate gradients' next factor: beta (colour 0) after the dots,
// alpha (colour 1) after the direction. Flexible beta (Polak and Ribiere): the multigrid is no
// symmetric operator.
#include "shared/bindings.h"

layout(local_size_x = WIND_SOLVE_GROUP) in;
layout(std430, binding = BIND_WIND_PARTIALS) readonly buffer WindPartials {
    vec2 partials[];
};
layout(std430, binding = BIND_WIND_SCALARS) buffer WindScalars {
    float scalars[];
};
layout(location = 0) uniform int groups;
layout(location = 1) uniform int colour;

shared vec2 sums[WIND_SOLVE_GROUP];

void main() {
    int own = int(gl_LocalInvocationIndex);
    vec2 sum = vec2(0.0);
    for (int i = own; i < groups; i += WIND_SOLVE_GROUP) {
        sum += partials[i];
    }
    sums[own] = sum;
    barrier();
    for (int half_count = WIND_SOLVE_GROUP / 2; half_count > 0; half_count /= 2) {
        if (own < half_count) {
            sums[own] += sums[own + half_count];
        }
        barrier();
    }
    if (own == 0) {
        // Sums of residuals are below 0, or 0 where nothing is left to do.
        if (colour == 0) {
            scalars[1] = scalars[2] < 0.0 ? -scalars[0] * sums[0].y / scalars[2] : 0.0;
            scalars[2] = sums[0].x;
        } else {
            scalars[0] = sums[0].x < 0.0 ? scalars[2] / sums[0].x : 0.0;
        }
    }
}
