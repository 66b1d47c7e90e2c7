// SPDX-License-Identifier: Apache-2.0
// In: segments of survivors. Out: one list without gaps, in the segments' order, and the draw command.
#include "shared/bindings.h"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_SEGMENTS) readonly buffer Segments { uvec2 segments[]; };
layout(std430, binding = BIND_SEGMENT_COUNTS) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BIND_VISIBLE) writeonly buffer Visible { uvec2 visible[]; };
layout(std430, binding = BIND_DRAW_COMMAND) buffer Command {
    uint vertices, instances, first, base;
    uint total, pad0, pad1, pad2;
};

shared uint sums[CULL_GROUP];

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    uint before = 0u;
    for (uint i = lane; i < group; i += uint(CULL_GROUP)) {
        before += counts[i];
    }
    sums[lane] = before;
    barrier();
    for (uint half_width = uint(CULL_GROUP) / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            sums[lane] += sums[lane + half_width];
        }
        barrier();
    }
    uint offset = sums[0];
    if (lane < counts[group]) {
        visible[offset + lane] = segments[group * uint(CULL_GROUP) + lane];
    }
    if (lane == 0u && group == gl_NumWorkGroups.x - 1u) {
        vertices = offset + counts[group];
        total += vertices;
    }
}
