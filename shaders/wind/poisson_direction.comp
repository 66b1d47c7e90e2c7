// SPDX-License-Identifier: Apache-2.0
// In: correction, last direction, beta. Out: next direction, its product with the operator, the sum
// of direction * product.
#include "wind/poisson.glsl"
#include "wind/sums.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_DIRECTION) readonly buffer WindDirection {
    float direction[];
};
layout(std430, binding = BIND_WIND_NEXT_DIRECTION) writeonly buffer WindNextDirection {
    float next_direction[];
};
layout(std430, binding = BIND_WIND_PRODUCT) writeonly buffer WindProduct {
    float product[];
};
layout(std430, binding = BIND_WIND_SCALARS) readonly buffer WindScalars {
    float scalars[];
};

float direction_at(ivec2 c) {
    int at = element(0, held(0, c));
    return beyond(0, c) ? 0.0 : phi[at] + scalars[1] * direction[at];
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    vec2 own_sums = vec2(0.0);
    if (all(lessThan(c, ivec2(side_of(0))))) {
        int own = element(0, c);
        float here = direction_at(c);
        vec4 around = vec4(direction_at(c - ivec2(1, 0)), direction_at(c + ivec2(1, 0)),
                           direction_at(c - ivec2(0, 1)), direction_at(c + ivec2(0, 1)));
        float result = dot(unpack_weights(weights[own]), around - here);
        next_direction[own] = here;
        product[own] = result;
        own_sums.x = here * result;
    }
    add_up(own_sums);
}
