// SPDX-License-Identifier: Apache-2.0
// The ground through a long lens: past the blades, levels are finer than the clipmap holds there,
// and are read from the posts. For programs with FINE_GROUND; lib/ground.glsl includes it.
#include "lib/posts.glsl"

// World place (anchor-relative) to a true one. Posts of a level are whole numbers of half metres:
// exact in floats.
vec2 true_place(vec2 xz) {
    return xz + params.anchor;
}

bool is_fine(vec2 xz) {
    vec2 from_eye = abs(xz - frame.eye.xz);
    return max(from_eye.x, from_eye.y) > params.detail_from_m;
}

// Spacing (m) of the place's level, without steps.
float fine_spacing(ClipPlace place) {
    return frame.clip[place.level].spacing_m * (1.0 + place.blend);
}

// Height above the datum of one level as the mesh has it: linear between its posts.
float level_height(vec2 xz, int level) {
    float spacing = frame.clip[level].spacing_m;
    vec2 at = true_place(xz) / spacing;
    vec2 base = floor(at);
    vec2 f = at - base;
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = vec2(float(i & 1), float(i >> 1));
        vec2 share = mix(1.0 - f, f, corner);
        if (share.x * share.y > 0.0) {
            sum += share.x * share.y * surface_height((base + corner) * spacing, spacing);
        }
    }
    return sum;
}

// World y at a vertex of a block: as with the clipmap, wholly of the next level where blocks of
// that level begin, so that no seam cracks.
float fine_vertex(vec2 xz, ClipPlace place) {
    float fine = level_height(xz, place.level);
    float coarse = place.blend > 0.0 ? level_height(xz, place.level + 1) : fine;
    return mix(fine, coarse, place.blend) - frame.anchor_height_m;
}

// World y at any place: the surface that the mesh follows.
float fine_height(vec2 xz, ClipPlace place) {
    return surface_height(true_place(xz), fine_spacing(place)) - frame.anchor_height_m;
}

// What clipmap_surface.comp stores: slope as a normal's x and z, density by the slope, tint.
vec4 fine_surface(vec2 xz, ClipPlace place) {
    float step_m = fine_spacing(place);
    vec2 at = true_place(xz);
    vec2 slope = vec2(surface_height(at + vec2(step_m, 0.0), step_m) -
                          surface_height(at - vec2(step_m, 0.0), step_m),
                      surface_height(at + vec2(0.0, step_m), step_m) -
                          surface_height(at - vec2(0.0, step_m), step_m)) /
                 (2.0 * step_m);
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    return vec4(normal.xz, slope_density(normal, at), surface_tint(at, step_m));
}
