// SPDX-License-Identifier: Apache-2.0
// In: blades that gather.comp listed for a picture, the picture as drawn so far. Out: of each
// command's blades those that a sample falls on which shows nothing nearer. Batches come from near
// to far: of a far field all but a few blades stand behind others.
#define BEFORE_SCENE
#include "lib/blade_samples.glsl"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_SURVIVORS) buffer Survivors {
    uvec2 survivors[];
};
layout(std430, binding = BIND_DRAW_COMMANDS) buffer Commands {
    DrawCommand commands[];
};
layout(std430, binding = BIND_CHOICE_TOTAL) buffer ChoiceTotals {
    uint totals[CULL_COUNTS];
};

shared uint kept_bits[CULL_GROUP / 32]; // a bit a lane, as in cull.comp

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    uint count = commands[group].vertices;
    uint first = commands[group].first;
    if (lane < uint(CULL_GROUP / 32)) {
        kept_bits[lane] = 0u;
    }
    barrier();
    uvec2 which = uvec2(0u);
    bool kept = false;
    if (lane < count) {
        which = survivors[first + lane];
        BladeRecord blade = tile_blade(which.x, which.y);
        kept = pictures_with(blade, blade_pose(which, blade)) != 0u;
    }
    if (kept) {
        atomicOr(kept_bits[lane / 32u], 1u << (lane % 32u));
    }
    barrier();
    uint before = uint(bitCount(kept_bits[lane / 32u] & ((1u << (lane % 32u)) - 1u)));
    for (uint word = 0u; word < lane / 32u; ++word) {
        before += uint(bitCount(kept_bits[word]));
    }
    if (kept) {
        survivors[first + before] = which;
    }
    if (lane == uint(CULL_GROUP) - 1u && count > 0u) {
        uint left = before + (kept ? 1u : 0u);
        commands[group].vertices = left;
        atomicAdd(totals[CULL_OCCLUSION], count - left);
        atomicAdd(totals[CULL_KEPT], left - count); // which choose.comp counted: modulo 2^32
    }
}
