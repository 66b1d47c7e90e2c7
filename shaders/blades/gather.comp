// SPDX-License-Identifier: Apache-2.0
// In: the masks that choose.comp made, a picture. Out: the picture's blades of each GATHER_ITEMS
// chunks in their order, and draw commands of CULL_GROUP blades at most. One lane does all of that:
// sums over a workgroup cost more, in software by far.
#include "shared/bindings.h"
#include "shared/frame.h"

layout(local_size_x = GATHER_GROUP) in;
layout(std430, binding = BIND_CULL_ITEMS) readonly buffer Items {
    uvec2 items[];
};
layout(std430, binding = BIND_GATHER_MASKS) readonly buffer GatherMasks {
    uint masks[];
};
layout(std430, binding = BIND_SURVIVORS) writeonly buffer Survivors {
    uvec2 survivors[];
};
layout(std430, binding = BIND_DRAW_COMMANDS) writeonly buffer Commands {
    DrawCommand commands[];
};
uniform int first_item;
uniform int end_item;
uniform int first_mask; // item whose masks lie first
uniform int picture;    // of the round

void main() {
    int lane = int(gl_GlobalInvocationID.x);
    int begin = first_item + lane * GATHER_ITEMS;
    int end = min(begin + GATHER_ITEMS, end_item);
    if (begin >= end) {
        return;
    }
    int first = lane * GATHER_ITEMS * CULL_GROUP;
    int place = first;
    uint both = 0x10001u << picture;
    for (int item = begin; item < end; ++item) {
        int words = (item - first_mask) * (CULL_GROUP / 2); // of two blades each
        uvec2 which = items[item];
        for (int word = 0; word < CULL_GROUP / 2; ++word) {
            for (uint bits = masks[words + word] & both; bits != 0u; bits &= bits - 1u) {
                survivors[place] = which + uvec2(0u, uint(2 * word + (findLSB(bits) >> 4)));
                ++place;
            }
        }
    }
    for (int command = 0; command < end - begin; ++command) {
        int count = clamp(place - first - command * CULL_GROUP, 0, CULL_GROUP);
        commands[lane * GATHER_ITEMS + command] =
            DrawCommand(uint(count), 1u, uint(first + command * CULL_GROUP), 0u);
    }
}
