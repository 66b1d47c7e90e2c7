// SPDX-License-Identifier: Apache-2.0
// Where what has passed is kept: pages of cells, their coarser levels, the blocks of them that
// move.
#ifndef SWARD_SHARED_TRACK_FIELD_H
#define SWARD_SHARED_TRACK_FIELD_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kTrackCells = 128; // a side of a page
SHARED_CONST int kTrackLevels = 6;  // of what is seen of it: 128 to 4 cells a side
SHARED_CONST int kTrackWords =
    27296; // a page's: its cells', one each, and two each of the coarser levels'
SHARED_CONST int kTrackBlock =
    16; // a side of a block: what moves of a page moves in blocks, a workgroup each
SHARED_CONST int kTrackRow = 8; // blocks a side of a page
SHARED_CONST int kTrackBlocks = 64;

// Where track_at() finds its answer. 64 bytes.
struct TrackField {
    vec2 place;     // the anchor in its page x, z (m)
    float per_m;    // 1 / cell
    float left;     // share of `pressed` that is
    ivec2 page;     // of the anchor x, z
    int table_mask; // of the table of pages, 0 or less: no tracks
    float wave_mps; // c0
    vec2 least;     // x, z of all pages, anchor-relative (m)
    vec2 most;
    float wave_gain_m;                  // mu
    float unused_a, unused_b, unused_c; // to 16 bytes
};
#ifdef __cplusplus
static_assert(sizeof(TrackField) == 64);
#endif

// The four cells around a place of a level, and the place among them. `cells`: from the anchor
// page's north-west corner.
SHARED_FN vec2 track_level_place(TrackField field, vec2 xz, int level) {
    return (field.place + xz) * (field.per_m * exp2(-float(level))) - vec2(0.5f, 0.5f);
}

// First word of a level within a page: its cells, one each; then 64^2, 32^2, ... of two.
SHARED_FN int track_level_first(int level) {
    int first = 0;
    for (int l = 0; l < level; ++l) {
        first += (kTrackCells >> l) * (kTrackCells >> l) * (l == 0 ? 1 : 2);
    }
    return first;
}

// A cell's block in its page, and its number in that block.
SHARED_FN int track_block_of(ivec2 cell) {
    return (cell.y / kTrackBlock) * kTrackRow + cell.x / kTrackBlock;
}
SHARED_FN int track_in_block(ivec2 cell) {
    return (cell.y % kTrackBlock) * kTrackBlock + cell.x % kTrackBlock;
}

// Where the table of pages is looked into first.
SHARED_FN int track_hash(ivec2 page) {
    return int((uint(page.x) * 73856093u ^ uint(page.y) * 19349663u) & 0x7fffffffu);
}

SHARED_END
#endif
