// SPDX-License-Identifier: Apache-2.0
// In: chunks of tiles' blades. Out: each workgroup's survivors in its own segment, and its draw
// command. SURFACE: an item is a cluster of a mesh's blades: the end of its run, its first blade.
#include "lib/frame.glsl" // here: a file is expanded once, in whichever branch names it first
#include "shared/bend.h"
#include "shared/blade.h"
#ifdef SURFACE
#include "lib/surface_place.glsl"
#else
#include "lib/blade_place.glsl"
#endif
#include "lib/occlusion.glsl"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_CULL_ITEMS) readonly buffer Items {
    uvec2 items[];
};
layout(std430, binding = BIND_SURVIVORS) writeonly buffer Survivors {
    uvec2 survivors[];
};
layout(std430, binding = BIND_DRAW_COMMANDS) writeonly buffer Commands {
    DrawCommand commands[];
};
layout(std430, binding = BIND_CULL_TOTAL) buffer Totals {
    uint totals[CULL_COUNTS];
};
uniform int first_item;
uniform int tests; // bits 1 << CULL_*

shared uint counts[CULL_COUNTS];
shared uint kept_bits[CULL_GROUP /
                      32]; // a bit a lane: or-ing commutes, so the order is the lanes' in every run

// J7 frustum test on the sphere around the blade; bent blades stay within their length of the root.
bool in_view(vec3 root, float reach) {
    vec4 clip = frame.clip_from_world * vec4(root, 1.0);
    vec2 slack = reach * vec2(length(vec3(frame.clip_from_world[0].x, frame.clip_from_world[1].x,
                                          frame.clip_from_world[2].x)),
                              length(vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y,
                                          frame.clip_from_world[2].y)));
    return clip.w > -reach && abs(clip.x) < clip.w + slack.x + reach &&
           abs(clip.y) < clip.w + slack.y + reach;
}

bool tested(uint test) {
    return (tests & (1 << test)) != 0;
}

// J7: seen along its width a blade is its fold alone. The printed inequality is the wrong way
// round.
bool edge_on(vec3 root, vec3 across) {
    return abs(dot(normalize(root - frame.eye), across)) > 0.9;
}

#ifdef SURFACE
// The test that takes a blade, or CULL_KEPT; CULL_COUNTS where there is none.
uint verdict(uvec2 item, uint index) {
    if (index >= item.x) {
        return uint(CULL_COUNTS);
    }
    SurfaceBlade blade = surface_blades[index];
    vec3 root = surface_root(blade);
    float reach = blade.v1_height.w;
    if (!handover_may_be_near(surface_rank_seed(index).x, distance(root, frame.lod_eye),
                              frame.handover_band, frame.handover_mode)) {
        return uint(CULL_LEFT);
    }
    if (tested(CULL_FRUSTUM) && !in_view(root, reach)) {
        return uint(CULL_FRUSTUM);
    }
    if (tested(CULL_ORIENTATION) &&
        edge_on(root, surface_width_direction(blade.up_stiffness.xyz, blade.root_direction.w))) {
        return uint(CULL_ORIENTATION);
    }
    if (surface_width_share(index, root, blade.up_stiffness.xyz) <= 0.0) {
        return uint(CULL_DISTANCE);
    }
    if (tested(CULL_OCCLUSION) && occluded(root, reach)) {
        return uint(CULL_OCCLUSION);
    }
    return uint(CULL_KEPT);
}
#else
// The test that takes a blade, or CULL_KEPT; CULL_COUNTS where there is none.
uint verdict(uvec2 item, uint index) {
    if (index >= tiles[item.x].end) {
        return uint(CULL_COUNTS);
    }
    BladeRecord blade = tile_blade(item.x, index);
    vec3 root = blade_root(item.x, blade);
    if (!handover_may_be_near(blade.root.z, distance(root, frame.lod_eye), frame.handover_band,
                              frame.handover_mode) ||
        blade.root.w >= ground_surface(root.xz).density) {
        return uint(CULL_LEFT);
    }
    if (tested(CULL_FRUSTUM) && !in_view(root, blade.shape.y * highest())) {
        return uint(CULL_FRUSTUM);
    }
    if (tested(CULL_ORIENTATION) && edge_on(root, blade_width_direction(blade.shape.x))) {
        return uint(CULL_ORIENTATION);
    }
    // Wherever it bends to, a blade stays within its length of its root.
    if (tested(CULL_OCCLUSION) && occluded(root, blade.shape.y * highest())) {
        return uint(CULL_OCCLUSION);
    }
    return uint(CULL_KEPT);
}
#endif

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    if (lane < uint(CULL_GROUP / 32)) {
        kept_bits[lane] = 0u;
    }
    if (lane < uint(CULL_COUNTS)) {
        counts[lane] = 0u;
    }
    barrier();
    uvec2 item = items[uint(first_item) + group];
    uint index = item.y + lane;
    uint found = verdict(item, index);
    bool kept = found == uint(CULL_KEPT);
    if (found < uint(CULL_COUNTS)) {
        atomicAdd(counts[found], 1u);
    }
    if (kept) {
        atomicOr(kept_bits[lane / 32u], 1u << (lane % 32u));
    }
    barrier();
    uint before = uint(bitCount(kept_bits[lane / 32u] & ((1u << (lane % 32u)) - 1u)));
    for (uint word = 0u; word < lane / 32u; ++word) {
        before += uint(bitCount(kept_bits[word]));
    }
    uint first = group * uint(CULL_GROUP);
    if (kept) {
        survivors[first + before] = uvec2(item.x, index);
    }
    if (lane == uint(CULL_GROUP) - 1u) {
        uint count = before + (kept ? 1u : 0u);
        commands[group] = DrawCommand(count, 1u, first, 0u);
    }
    if (lane < uint(CULL_COUNTS) && counts[lane] > 0u) { // once a workgroup
        atomicAdd(totals[lane], counts[lane]);
    }
}
