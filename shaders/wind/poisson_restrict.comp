// SPDX-License-Identifier: Apache-2.0
// In: a level after a red-black sweep. Out: the right side of the coarser one: the sum of four
// residuals, of which the two black ones are 0.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;

// Residual of a fine cell if it belongs to `coarse`, else 0.
float residual(ivec2 c, ivec2 coarse) {
    ivec2 near = held(level, c);
    int own = element(level, near);
    vec4 w = unpack_weights(weights[own]);
    bool ours = w != vec4(0.0) && source_of(near, w) == coarse;
    return ours ? rhs[own] - dot(w, phi_around(near)) + own_weight(w) * phi[own] : 0.0;
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, ivec2(side_of(level + 1))))) {
        return;
    }
    int own = element(level + 1, c);
    ivec2 f = 2 * c;
    float sum = residual(f, c) + residual(f + 1, c);
    vec4 w = unpack_weights(weights[own]);
    if (w.x < 1.0 &&
        c.x > 0) { // cells cut off from their parents by a wall at our west side, and the like
        sum += residual(f + ivec2(-1, 1), c);
    }
    if (w.z < 1.0 && c.y > 0) {
        sum += residual(f + ivec2(1, -1), c);
    }
    rhs[own] = sum;
}
