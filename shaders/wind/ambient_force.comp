// SPDX-License-Identifier: Apache-2.0
// In: velocities of the ambient tile, their totals, stream functions of the gusts. Out: velocities
// drawn a little to the synthesised gusts of this time, with mean 0 and the strength that the scene
// asks for.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_TARGET) readonly buffer WindTarget {
    vec2 stream[];
};
layout(std430, binding = BIND_WIND_TOTALS) readonly buffer WindTotals {
    float totals[];
};
layout(location = 0) uniform vec4
    cosines; // of the groups' phases, times their scale (1/m); w: share that a step is drawn
layout(location = 1) uniform vec4 sines; // likewise; w: root mean square to keep (m/s a component)

float psi(int corner) {
    int count = grid.cells * grid.cells;
    vec2 a = stream[corner], b = stream[count + corner], c = stream[2 * count + corner];
    return dot(cosines.xyz, vec3(a.x, b.x, c.x)) + dot(sines.xyz, vec3(a.y, b.y, c.y));
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    float here = psi(own);
    vec2 target =
        vec2(psi(near_index(c + ivec2(0, 1))) - here, here - psi(near_index(c + ivec2(1, 0))));
    vec2 mean = vec2(totals[0], totals[1]);
    float strength = sqrt(max(0.5 * (totals[2] - dot(mean, mean)), 1e-12));
    vec2 velocity = (vec2(wind_u[own], wind_v[own]) - mean) * clamp(sines.w / strength, 0.9, 1.1);
    velocity += (target - velocity) * cosines.w;
    wind_u[own] = velocity.x;
    wind_v[own] = velocity.y;
}
