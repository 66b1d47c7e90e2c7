// SPDX-License-Identifier: Apache-2.0
// In: cells of the pages that have changed. Out: one level of what track_at() reads of them: cells at level 0, means of four above it.
#include "tracks/cells.glsl"

layout(std430, binding = BIND_TRACK_SHOWN) buffer TrackShown { uvec2 shown[]; };
uniform int level;

vec4 shown_at(int index) {
    uvec2 both = shown[index];
    return vec4(unpackHalf2x16(both.x), unpackHalf2x16(both.y));
}

void main() {
    int side = kTrackCells >> level;
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= side || cell.y >= side) {
        return;
    }
    int slot = pages[gl_WorkGroupID.z].slot.x;
    vec4 value;
    if (level == 0) {
        int own = cell_index(slot, cell);
        value = vec4(bends[own].xy, pressed[own]);
    } else {
        int below = slot * kTrackTexels + track_level_first(level - 1) + 2 * (2 * side * cell.y + cell.x);
        value = 0.25 * (shown_at(below) + shown_at(below + 1) + shown_at(below + 2 * side) + shown_at(below + 2 * side + 1));
    }
    shown[slot * kTrackTexels + track_level_first(level) + side * cell.y + cell.x] = uvec2(packHalf2x16(value.xy), packHalf2x16(value.zw));
}
