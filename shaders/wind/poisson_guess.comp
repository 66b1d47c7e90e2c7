// SPDX-License-Identifier: Apache-2.0
// In: pressure of the last two steps. Out: what it would be now if it went on changing as it did,
// the solver's first guess.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_PRESSURE) buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_EARLIER_PRESSURE) buffer WindEarlierPressure {
    float earlier_pressure[];
};

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, ivec2(side_of(0))))) {
        return;
    }
    int own = element(0, c);
    float last = pressure[own];
    pressure[own] = 2.0 * last - earlier_pressure[own];
    earlier_pressure[own] = last;
}
