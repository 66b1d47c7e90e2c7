// SPDX-License-Identifier: Apache-2.0
// In: changes of the pages that move, the prints that touch them. Out: bends a step on, held where something touches them (C1, C4), and what
// lies pressed. PRESS_ONLY: the latter alone, for a time so long ago that bends have risen since, a workgroup's cells a page entry. The twin is tracks::TrackTwin.
#include "tracks/cells.glsl"

layout(std430, binding = BIND_TRACK_PRINTS) readonly buffer TrackPrints { TrackPrint prints[]; };

void main() {
    TrackPage page = pages[gl_WorkGroupID.z];
#ifdef PRESS_ONLY
    ivec2 cell = ivec2(page.slot.w & 255, page.slot.w >> 8) + ivec2(gl_LocalInvocationID.xy);
#else
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
#endif
    int own = cell_index(page.slot.x, cell);
    TrackRules rules = the_rules();
    vec2 middle = rules.grid.x * (vec2(cell) + 0.5);
#ifndef PRESS_ONLY
    TrackCell next = track_advance(cell_at(own), changes[own]);
#endif
    for (int n = page.slot.y; n < page.slot.y + page.slot.z; ++n) {
        TrackContact contact = track_contact(rules, prints[n], middle);
        if (contact.touched == 1) {
            pressed[own] = track_pressed(rules, pressed[own], contact, prints[n].shape.w);
#ifndef PRESS_ONLY
            next = track_bent(rules, next, contact, page.ground.xy);
#endif
        }
    }
#ifndef PRESS_ONLY
    bends[own] = vec4(next.theta, next.omega);
    changes[own] = vec4(next.theta_step, next.omega_step);
#endif
}
