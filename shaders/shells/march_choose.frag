// SPDX-License-Identifier: Apache-2.0
// In: the canopy's upper surface. Out: as depth, by which kind of textures a pixel is to be marched (kind_depth), 0 where it sees no canopy:
// each kind is a pass of its own over its pixels, and none of them pays for the others' fetches.
#include "shells/march_view.glsl"

in vec2 ndc;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    View view = view_of(pixel, ndc);
    Entry entry = entry_of(view, pixel);
    gl_FragDepth = 0.0;
    if (entry.distance < kNever) {
        MarchPath path = path_of(view, entry);
        bool crest = at_crest(path);
        if (crest || entry.distance + 1.2 * ground_reach(path) > near_reach()) { // the ground curves a little
            gl_FragDepth = kind_depth(plan_of(view, entry, path).kind, crest);
        }
    }
}
