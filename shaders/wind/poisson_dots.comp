// SPDX-License-Identifier: Apache-2.0
// In: residual, its correction by the multigrid, the last product. Out: sums of correction *
// residual and correction * product.
#include "wind/poisson.glsl"
#include "wind/sums.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRODUCT) readonly buffer WindProduct {
    float product[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    vec2 own_sums = vec2(0.0);
    if (all(lessThan(c, ivec2(side_of(0))))) {
        int own = element(0, c);
        own_sums = phi[own] * vec2(rhs[own], product[own]);
    }
    add_up(own_sums);
}
