// SPDX-License-Identifier: Apache-2.0
// In: chunks of tiles' blades. Out: each workgroup's survivors in its own segment, and their count.
#include "lib/blade_place.glsl"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_CULL_ITEMS) readonly buffer Items { uvec2 items[]; };
layout(std430, binding = BIND_SEGMENTS) writeonly buffer Segments { uvec2 segments[]; };
layout(std430, binding = BIND_SEGMENT_COUNTS) writeonly buffer Counts { uint counts[]; };
uniform int first_item;

shared uint sums[CULL_GROUP];

// J7 frustum test on the sphere around the blade; bent blades stay within their length of the root.
bool in_view(vec3 root, float reach) {
    vec4 clip = frame.clip_from_world * vec4(root, 1.0);
    vec2 slack = reach * vec2(length(vec3(frame.clip_from_world[0].x, frame.clip_from_world[1].x, frame.clip_from_world[2].x)),
                              length(vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y)));
    return clip.w > -reach && abs(clip.x) < clip.w + slack.x + reach && abs(clip.y) < clip.w + slack.y + reach;
}

bool keep(uvec2 item, uint index) {
    if (index >= uint(tiles[item.x].place.z)) {
        return false;
    }
    BladeRecord blade = blades[index];
    vec3 root = blade_root(item.x, blade);
    return handover_may_be_near(blade.root.z, distance(root, frame.lod_eye.xyz), frame.handover.xy, frame.mode.x) &&
           blade.root.w < ground_surface(root.xz).density && in_view(root, blade.shape.y);
}

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    uvec2 item = items[uint(first_item) + group];
    uint index = item.y + lane;
    bool kept = keep(item, index);
    sums[lane] = kept ? 1u : 0u;
    barrier();
    for (uint step = 1u; step < uint(CULL_GROUP); step *= 2u) { // inclusive scan
        uint add = lane >= step ? sums[lane - step] : 0u;
        barrier();
        sums[lane] += add;
        barrier();
    }
    if (kept) {
        segments[group * uint(CULL_GROUP) + sums[lane] - 1u] = uvec2(item.x, index);
    }
    if (lane == uint(CULL_GROUP) - 1u) {
        counts[group] = sums[lane];
    }
}
