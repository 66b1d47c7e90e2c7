// SPDX-License-Identifier: Apache-2.0
// In: the masks that choose.comp made, a picture. Out: the picture's blades of each GATHER_ITEMS chunks in their order, and draw commands
// of CULL_GROUP blades at most.
#include "shared/bindings.h"
#include "shared/frame.h"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_CULL_ITEMS) readonly buffer Items { uvec2 items[]; };
layout(std430, binding = BIND_GATHER_MASKS) readonly buffer Masks { uint masks[]; };
layout(std430, binding = BIND_SURVIVORS) writeonly buffer Survivors { uvec2 survivors[]; };
layout(std430, binding = BIND_DRAW_COMMANDS) writeonly buffer Commands { DrawCommand commands[]; };
uniform int first_item;
uniform int end_item;
uniform int first_mask; // item whose masks lie first
uniform int picture;    // of the round

shared uint sums[CULL_GROUP];

const int kWords = GATHER_ITEMS / 2; // a lane's, of two blades each

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int group = int(gl_WorkGroupID.x);
    int first_word = lane * kWords; // of the group's
    int item = first_item + group * GATHER_ITEMS + first_word / (CULL_GROUP / 2);
    int in_item = first_word % (CULL_GROUP / 2);
    uint bits = 0u; // a blade each
    if (item < end_item) {
        for (int word = 0; word < kWords; ++word) {
            uint mask = masks[(item - first_mask) * (CULL_GROUP / 2) + in_item + word] >> picture;
            bits |= ((mask & 1u) | (mask >> 15 & 2u)) << (2 * word);
        }
    }
    sums[lane] = uint(bitCount(bits));
    barrier();
    for (int step = 1; step < CULL_GROUP; step *= 2) { // inclusive prefix sums
        uint before = lane >= step ? sums[lane - step] : 0u;
        barrier();
        sums[lane] += before;
        barrier();
    }
    int first = group * GATHER_ITEMS * CULL_GROUP;
    int place = first + int(sums[lane]) - bitCount(bits);
    for (; bits != 0u; bits &= bits - 1u) {
        survivors[place] = uvec2(items[item].x, items[item].y + uint(2 * in_item + findLSB(bits)));
        ++place;
    }
    if (lane < GATHER_ITEMS) {
        int count = clamp(int(sums[CULL_GROUP - 1]) - lane * CULL_GROUP, 0, CULL_GROUP);
        commands[group * GATHER_ITEMS + lane] = DrawCommand(uint(count), 1u, uint(first + lane * CULL_GROUP), 0u);
    }
}
