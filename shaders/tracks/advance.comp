// SPDX-License-Identifier: Apache-2.0
// In: changes of the blocks that move, the prints that touch them. Out: bends a step on, held where something touches them (C1, C4), and what
// lies pressed. PRESS_ONLY: the latter alone, of blocks at rest. The twin is tracks::TrackTwin.
#include "tracks/cells.glsl"

layout(std430, binding = BIND_TRACK_PRINTS) readonly buffer TrackPrints { TrackPrint prints[]; };

void main() {
    TrackBlock block = blocks[gl_WorkGroupID.z];
    ivec2 cell = ivec2(block.page.w & 255, block.page.w >> 8) + ivec2(gl_LocalInvocationID.xy);
    int word = cell_word(block.page.x, cell);
    TrackRules rules = the_rules();
    vec2 middle = rules.grid.x * (vec2(cell) + 0.5);
    vec2 pressed = track_unpack(shown[word]);
    bool touched = false;
#ifndef PRESS_ONLY
    int own = moving_index(block.own.x, ivec2(gl_LocalInvocationID.xy));
    TrackCell next = track_advance(cell_at(own), changes[own]);
#endif
    for (int n = block.page.y; n < block.page.y + block.page.z; ++n) {
        TrackContact contact = track_contact(rules, prints[n], middle);
        if (contact.touched == 1) {
            touched = true;
            pressed = track_pressed(rules, pressed, contact, prints[n].shape.w);
#ifndef PRESS_ONLY
            next = track_bent(rules, next, contact, block.ground.xy);
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
