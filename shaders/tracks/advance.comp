// SPDX-License-Identifier: Apache-2.0
// In: changes of the blocks that move, the prints that touch them. Out: bends a step on, held where
// something touches them (C1, C4), and what lies pressed. PRESS_ONLY: the latter alone, of blocks
// at rest. The twin is tracks::TrackTwin.
#include "tracks/cells.glsl"

layout(std430, binding = BIND_TRACK_PRINTS) readonly buffer TrackPrints {
    TrackPrint prints[];
};

void main() {
    TrackBlock block = blocks[gl_WorkGroupID.z];
    ivec2 cell = block.first_cell + ivec2(gl_LocalInvocationID.xy);
    int word = cell_word(block.slot, cell);
    TrackRules rules = the_rules();
    vec2 middle = rules.cell_m * (vec2(cell) + 0.5);
    vec2 pressed = track_unpack(shown[word]);
    bool touched = false;
#ifndef PRESS_ONLY
    int own = moving_index(block.own, ivec2(gl_LocalInvocationID.xy));
    TrackCell next = track_advance(cell_at(own), changes[own]);
#endif
    for (int n = block.first_print; n < block.first_print + block.prints; ++n) {
        TrackContact contact = track_contact(rules, prints[n], middle);
        if (contact.touched == 1) {
            touched = true;
            pressed = track_pressed(rules, pressed, contact, prints[n].load);
#ifndef PRESS_ONLY
            next = track_bent(rules, next, contact, block.slope);
#endif
        }
    }
    if (touched) {
        shown[word] = track_pack(pressed);
    }
#ifndef PRESS_ONLY
    bends[own] = vec4(next.theta, next.omega);
    changes[own] = vec4(next.theta_step, next.omega_step);
#endif
}
