// SPDX-License-Identifier: Apache-2.0
// A whole red-black sweep from phi = 0: what every level begins with.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;

float red_at(ivec2 c) {
    int at = element(level, held(level, c));
    return beyond(level, c) ? 0.0 : relaxed(unpack_weights(weights[at]), vec4(0.0), rhs[at]);
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, ivec2(side_of(level))))) {
        return;
    }
    int own = element(level, c);
    vec4 around = vec4(0.0);
    if (((c.x + c.y) & 1) != 0) {
        around = vec4(red_at(c - ivec2(1, 0)), red_at(c + ivec2(1, 0)), red_at(c - ivec2(0, 1)),
                      red_at(c + ivec2(0, 1)));
    }
    phi[own] = relaxed(unpack_weights(weights[own]), around, rhs[own]);
}
