// SPDX-License-Identifier: Apache-2.0
// In: bends of the blocks that move, and of those beside them. Out: their cells' changes (C2).
// Blocks share their rims: beside its end one reads the next one's cell, its own where that is at
// rest. Only changes are written, so that no order of blocks matters.
#include "tracks/cells.glsl"

vec4 beside(TrackBlock block, ivec2 cell, ivec2 by) {
    ivec2 at = cell + by;
    int place = block.own;
    if (at.x < 0 || at.x >= kTrackBlock || at.y < 0 || at.y >= kTrackBlock) {
        place = at.x < 0              ? block.beside.x
                : at.x >= kTrackBlock ? block.beside.y
                : at.y < 0            ? block.beside.z
                                      : block.beside.w;
        at = place < 0 ? cell : (at + kTrackBlock) % kTrackBlock;
        place = place < 0 ? block.own : place;
    }
    return bends[moving_index(place, at)];
}

void main() {
    TrackBlock block = blocks[gl_WorkGroupID.z];
    ivec2 cell = ivec2(gl_LocalInvocationID.xy);
    int own = moving_index(block.own, cell);
    changes[own] = track_change(the_rules(), cell_at(own), beside(block, cell, ivec2(-1, 0)),
                                beside(block, cell, ivec2(1, 0)), beside(block, cell, ivec2(0, -1)),
                                beside(block, cell, ivec2(0, 1)));
}
