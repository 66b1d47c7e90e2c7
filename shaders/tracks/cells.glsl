// SPDX-License-Identifier: Apache-2.0
// Cells of the pages that are stepped, as the tracks' passes see them: a workgroup row of pages (z), 16 x 16 cells each.
#include "shared/bindings.h"
#include "shared/track.h"

layout(local_size_x = TRACK_GROUP, local_size_y = TRACK_GROUP) in;
layout(std430, binding = BIND_TRACK_BENDS) buffer TrackBends { vec4 bends[]; };     // theta, omega
layout(std430, binding = BIND_TRACK_CHANGES) buffer TrackChanges { vec4 changes[]; }; // of them, in the last step
layout(std430, binding = BIND_TRACK_PRESSED) buffer TrackPressed { vec2 pressed[]; };
layout(std430, binding = BIND_TRACK_PAGES) readonly buffer TrackPages { TrackPage pages[]; };
uniform vec4 rules_grid, rules_waves, rules_grass;

TrackRules the_rules() {
    return TrackRules(rules_grid, rules_waves, rules_grass);
}

int cell_index(int slot, ivec2 cell) {
    return (slot * kTrackCells + cell.y) * kTrackCells + cell.x;
}

TrackCell cell_at(int index) {
    vec4 bend = bends[index];
    vec4 change = changes[index];
    return TrackCell(bend.xy, bend.zw, change.xy, change.zw);
}
