// SPDX-License-Identifier: Apache-2.0
// A sum over all cells in one order: here a workgroup's share, in poisson_scalars.comp the rest.
layout(std430, binding = BIND_WIND_PARTIALS) buffer WindPartials {
    vec2 partials[];
};

shared vec2 sums[WIND_GROUP_X * WIND_GROUP_Y];

// Called by every thread of the workgroup.
void add_up(vec2 own) {
    int thread = int(gl_LocalInvocationIndex);
    sums[thread] = own;
    barrier();
    if (thread < WIND_GROUP_X) {
        vec2 sum = sums[thread];
        for (int i = 1; i < WIND_GROUP_Y; ++i) {
            sum += sums[thread + i * WIND_GROUP_X];
        }
        sums[thread] = sum;
    }
    barrier();
    if (thread == 0) {
        vec2 sum = sums[0];
        for (int i = 1; i < WIND_GROUP_X; ++i) {
            sum += sums[i];
        }
        partials[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
    }
}
