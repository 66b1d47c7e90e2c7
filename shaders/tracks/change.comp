// SPDX-License-Identifier: Apache-2.0
// In: bends of the pages that move, and of those beside them. Out: their cells' changes (C2). Pages share their rims: beside its end a page
// reads the next one's cell, its own where there is no other. Only changes are written, so that no order of pages matters.
#include "tracks/cells.glsl"

vec4 beside(TrackPage page, ivec2 cell, ivec2 by) {
    ivec2 at = cell + by;
    int slot = page.slot.x;
    if (at.x < 0 || at.x >= kTrackCells || at.y < 0 || at.y >= kTrackCells) {
        slot = at.x < 0 ? page.beside.x : at.x >= kTrackCells ? page.beside.y : at.y < 0 ? page.beside.z : page.beside.w;
        at = slot < 0 ? cell : (at + kTrackCells) % kTrackCells;
        slot = slot < 0 ? page.slot.x : slot;
    }
    return bends[cell_index(slot, at)];
}

void main() {
    TrackPage page = pages[gl_WorkGroupID.z];
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int own = cell_index(page.slot.x, cell);
    changes[own] = track_change(the_rules(), cell_at(own), beside(page, cell, ivec2(-1, 0)), beside(page, cell, ivec2(1, 0)),
                                beside(page, cell, ivec2(0, -1)), beside(page, cell, ivec2(0, 1)));
}
