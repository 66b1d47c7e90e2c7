// SPDX-License-Identifier: Apache-2.0
// A blade of grass: its record in the set, its curve and its outline (J1, J8). texgen rasterises
// this outline into the volume and the near tier tessellates it, so that both tiers show the same
// blade.
#ifndef SWARD_SHARED_BLADE_H
#define SWARD_SHARED_BLADE_H
#include "shared/types.h"

SHARED_BEGIN

// One blade of a patch, in its rest pose (J1), 64 bytes. Metres; y up. rank and seed are (n + 0.5)
// / 256, n = 0..255, so that an 8-bit texel holds them without loss.
struct BladeRecord {
    vec4 root;  // x, z within the patch [0, side); rank; seed
    vec4 v1;    // middle control point relative to the root; w: half width at the root
    vec4 v2;    // tip relative to the root; w: stiffness, 0 limp .. 1 stiff
    vec4 shape; // facing azimuth: width direction is (cos, 0, sin); curve length; droop; number of
                // the species
};
#ifdef __cplusplus
static_assert(sizeof(BladeRecord) == 64);
#endif

// Of a species' blades, as blade_width_at() takes it. 16 bytes.
struct BladeOutline {
    float taper;     // its power
    float stalk;     // its width over the head's
    float head_from; // v where the head begins, 1: none
    float fullness;  // of the head
};

// Point of the quadratic Bezier (root at 0) at parameter v (J8, c).
SHARED_FN vec3 blade_curve(vec3 v1, vec3 v2, float v) {
    return 2.0f * v * (1.0f - v) * v1 + v * v * v2;
}

// Unit tangent at v (J8, t0).
SHARED_FN vec3 blade_tangent(vec3 v1, vec3 v2, float v) {
    return normalize(mix(v1, v2 - v1, v) + vec3(0.0f, 1e-6f, 0.0f));
}

// A layer or slice shows a piece of blade flattened onto its plane, and so shorter or longer to the
// eye than it is. The ratio, as the factor on its coverage: without it, leaning blades are seen too
// often from one side and too rarely from the other.
SHARED_FN float flattening(vec3 tangent, vec3 flattened, vec3 to_eye) {
    vec3 whole = cross(tangent, to_eye);
    vec3 shown = cross(flattened, to_eye);
    return sqrt(min(dot(whole, whole) / max(dot(shown, shown), 1e-6f), 9.0f));
}

// Unit width direction (J8, t1).
SHARED_FN vec3 blade_width_direction(float facing) {
    return vec3(cos(facing), 0.0f, sin(facing));
}

// Half width at v over the greatest half width. A blade tapers as 1 - v^p (J8: p = 2 is the
// quadratic one, 1 the triangle). Seed heads, flowers and leaves are the same strip with a head on
// a thin stalk: (4 t (1 - t))^q over it, q = 1/2 an ellipse, 1 a spindle.
SHARED_FN float blade_width_at(float v, BladeOutline outline) {
    float stalk = outline.stalk * (1.0f - pow(v, outline.taper));
    float t = clamp((v - outline.head_from) / max(1.0f - outline.head_from, 1e-3f), 0.0f, 1.0f);
    return max(stalk,
               outline.head_from < 1.0f ? pow(4.0f * t * (1.0f - t), outline.fullness) : 0.0f);
}

// Where u in [0, 1] across the blade lands between its left (0) and right (1) rim at v. Written
// about the middle: the printed u - u v^2 has the same width but pins the left rim.
SHARED_FN float blade_outline(float u, float v, BladeOutline outline) {
    return 0.5f + (u - 0.5f) * blade_width_at(v, outline);
}

// v of the mesh's station t in [0, 1]: half of the stations stand on the head, where there is one.
SHARED_FN float blade_station(float t, BladeOutline outline) {
    float head = outline.head_from;
    return head >= 1.0f ? t : t < 0.5f ? 2.0f * t * head : head + (2.0f * t - 1.0f) * (1.0f - head);
}

// 8-bit number of a rank or seed, and back: exact on both sides.
SHARED_FN float unorm8_to_unit(float texel) {
    return (floor(texel * 255.0f + 0.5f) + 0.5f) / 256.0f;
}

SHARED_END
#endif
