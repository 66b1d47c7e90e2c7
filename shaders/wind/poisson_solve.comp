// SPDX-License-Identifier: Apache-2.0
// The coarsest level, solved by one workgroup: red-black over-relaxation from phi = 0.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_SOLVE_GROUP) in;

shared float value[WIND_SOLVE_SIDE * WIND_SOLVE_SIDE];

float value_at(ivec2 c) {
    ivec2 near = held(level, c);
    return beyond(level, c) ? 0.0 : value[near.y * side_of(level) + near.x];
}

void main() {
    int n = side_of(level), first = int(gl_LocalInvocationIndex);
    for (int i = first; i < n * n; i += WIND_SOLVE_GROUP) {
        value[i] = 0.0;
    }
    barrier();
    // Young's factor for a square with phi = 0 around it; a periodic one has half the longest wave.
#ifdef PERIODIC
    float over = 2.0 / (1.0 + sin(2.0 * kPi / float(n)));
#else
    float over = 2.0 / (1.0 + sin(kPi / float(n)));
#endif
    for (int half_sweep = 0; half_sweep < n + 8; ++half_sweep) {
        for (int i = first; i < n * n; i += WIND_SOLVE_GROUP) {
            ivec2 c = ivec2(i % n, i / n);
            if (((c.x + c.y + half_sweep) & 1) == 0) {
                int own = element(level, c);
                vec4 around = vec4(value_at(c - ivec2(1, 0)), value_at(c + ivec2(1, 0)),
                                   value_at(c - ivec2(0, 1)), value_at(c + ivec2(0, 1)));
                float old = value[i];
                value[i] =
                    old + over * (relaxed(unpack_weights(weights[own]), around, rhs[own]) - old);
            }
        }
        barrier();
    }
    for (int i = first; i < n * n; i += WIND_SOLVE_GROUP) {
        phi[element(level, ivec2(i % n, i / n))] = value[i];
    }
}
