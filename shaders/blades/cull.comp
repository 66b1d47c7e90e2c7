// SPDX-License-Identifier: Apache-2.0
// In: chunks of tiles' blades. Out: each workgroup's survivors in its own segment, and its draw command.
// SURFACE: an item is a cluster of a mesh's blades: the end of its run, its first blade.
#include "lib/frame.glsl" // here: a file is expanded once, in whichever branch names it first
#ifdef SURFACE
#include "lib/surface_place.glsl"
#else
#include "lib/blade_place.glsl"
#endif

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_CULL_ITEMS) readonly buffer Items { uvec2 items[]; };
layout(std430, binding = BIND_SURVIVORS) writeonly buffer Survivors { uvec2 survivors[]; };
layout(std430, binding = BIND_DRAW_COMMANDS) writeonly buffer Commands { DrawCommand commands[]; };
layout(std430, binding = BIND_CULL_TOTAL) buffer Total { uint total; };
uniform int first_item;

shared uint kept_bits[CULL_GROUP / 32]; // a bit a lane: or-ing commutes, so the order is the lanes' in every run

// J7 frustum test on the sphere around the blade; bent blades stay within their length of the root.
bool in_view(vec3 root, float reach) {
    vec4 clip = frame.clip_from_world * vec4(root, 1.0);
    vec2 slack = reach * vec2(length(vec3(frame.clip_from_world[0].x, frame.clip_from_world[1].x, frame.clip_from_world[2].x)),
                              length(vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y, frame.clip_from_world[2].y)));
    return clip.w > -reach && abs(clip.x) < clip.w + slack.x + reach && abs(clip.y) < clip.w + slack.y + reach;
}

#ifdef SURFACE
bool keep(uvec2 item, uint index) {
    return index < item.x && in_view(surface_root(surface_blades[index]), surface_blades[index].v1_height.w);
}
#else
bool keep(uvec2 item, uint index) {
    if (index >= uint(tiles[item.x].place.z)) {
        return false;
    }
    BladeRecord blade = blades[index];
    vec3 root = blade_root(item.x, blade);
    return handover_may_be_near(blade.root.z, distance(root, frame.lod_eye.xyz), frame.handover.xy, frame.mode.x) &&
           blade.root.w < ground_surface(root.xz).density && in_view(root, blade.shape.y);
}
#endif

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    if (lane < uint(CULL_GROUP / 32)) {
        kept_bits[lane] = 0u;
    }
    barrier();
    uvec2 item = items[uint(first_item) + group];
    uint index = item.y + lane;
    bool kept = keep(item, index);
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
        atomicAdd(total, count);
    }
}
