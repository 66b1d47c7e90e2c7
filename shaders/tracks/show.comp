// SPDX-License-Identifier: Apache-2.0
// In: cells of the pages that have changed. Out: one of the coarser levels of what track_at() reads
// of them, means of four of the level below it.
#include "tracks/cells.glsl"

layout(std430, binding = BIND_TRACK_TABLE) readonly buffer TrackTable {
    ivec4 table[];
};
uniform int level, table_size;

TrackSeen seen_cell(int slot, ivec2 cell) {
    int block = track_block_of(cell);
    int place = table[table_size + slot * (kTrackBlocks / 4) + block / 4][block % 4];
    vec2 theta =
        place < 0 ? vec2(0.0) : bends[place * kTrackBlock * kTrackBlock + track_in_block(cell)].xy;
    return track_seen(theta, track_unpack(shown[cell_word(slot, cell)]));
}

TrackSeen seen_below(int slot, ivec2 cell) {
    if (level == 1) {
        return seen_cell(slot, cell);
    }
    int at = slot * kTrackWords + track_level_first(level - 1) +
             2 * ((kTrackCells >> (level - 1)) * cell.y + cell.x);
    return track_unpack_seen(uvec2(shown[at], shown[at + 1]));
}

void main() {
    int side = kTrackCells >> level;
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= side || cell.y >= side) {
        return;
    }
    int slot = blocks[gl_WorkGroupID.z].slot;
    ivec2 from = 2 * cell;
    TrackSeen north = track_mean(seen_below(slot, from), seen_below(slot, from + ivec2(1, 0)), 0.5);
    TrackSeen south =
        track_mean(seen_below(slot, from + ivec2(0, 1)), seen_below(slot, from + ivec2(1, 1)), 0.5);
    uvec2 words = track_pack_seen(track_mean(north, south, 0.5));
    int at = slot * kTrackWords + track_level_first(level) + 2 * (side * cell.y + cell.x);
    shown[at] = words.x;
    shown[at + 1] = words.y;
}
