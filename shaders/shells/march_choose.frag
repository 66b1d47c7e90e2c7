// SPDX-License-Identifier: Apache-2.0
// In: the canopy's upper surface. Out: as depth, by which kind of textures a pixel is to be marched
// (kind_depth), 0 where it sees no canopy: each kind is a pass of its own over its pixels, and none
// of them pays for the others' fetches.
#include "shells/march_view.glsl"
uniform int samples;
#ifndef SURFACE
#include "shells/crest.glsl"
#endif

in vec2 ndc;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    View view = view_of(pixel, ndc);
    Entry entry = entry_of(view, pixel);
    bool edge = false;
#ifndef SURFACE
    if (eye_place.x < 0.5) {
        vec4 entries = sample_entries(view, pixel);
        bool missed = misses(entry, entries);
        if (missed && nearest_of(entries) < kNever) {
            entry = entry_at(view, nearest_of(entries));
        }
        edge = missed || dot(members_of(view, entries, entry.ground.xy), vec4(1.0)) < 4.0;
    }
#endif
    gl_FragDepth = 0.0;
    if (entry.distance < kNever) {
#ifndef SURFACE
        entry = settled(view, entry);
#endif
        MarchPath path = path_of(view, entry);
        bool crest = edge || at_crest(path);
        if (crest || entry.distance + 1.2 * ground_reach(path) >
                         near_reach()) { // the ground curves a little
            gl_FragDepth = kind_depth(plan_of(view, entry, path).kind, crest);
        }
    }
}
