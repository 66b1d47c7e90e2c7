// SPDX-License-Identifier: Apache-2.0
// Cells as the tracks' passes see them: a workgroup a block of 16 x 16, an entry of the work each
// (z). What lies has a word in its page; what bends has a place only in blocks that move.
#include "shared/bindings.h"
#include "shared/track.h"
#include "shared/track_seen.h"

layout(local_size_x = TRACK_GROUP, local_size_y = TRACK_GROUP) in;
layout(std430, binding = BIND_TRACK_BENDS) buffer TrackBends {
    vec4 bends[];
}; // theta, omega
layout(std430, binding = BIND_TRACK_CHANGES) buffer TrackChanges {
    vec4 changes[];
}; // of them, in the last step
layout(std430, binding = BIND_TRACK_SHOWN) buffer TrackShown {
    uint shown[];
};
layout(std430, binding = BIND_TRACK_WORK) readonly buffer TrackWork {
    TrackBlock blocks[];
};
uniform TrackRules step_rules;

TrackRules the_rules() {
    return step_rules;
}

// Word of what lies in a page's cell.
int cell_word(int slot, ivec2 cell) {
    return slot * kTrackWords + cell.y * kTrackCells + cell.x;
}

// A cell of a block in the pool of what moves.
int moving_index(int place, ivec2 cell) {
    return (place * kTrackBlock + cell.y) * kTrackBlock + cell.x;
}

TrackCell cell_at(int index) {
    vec4 bend = bends[index];
    vec4 change = changes[index];
    return TrackCell(bend.xy, bend.zw, change.xy, change.zw);
}
