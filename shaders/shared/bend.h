// SPDX-License-Identifier: Apache-2.0
// How grass bends: the closed form of B3 for shells and slices, W3 for grouped blades, J5 to keep a blade's length, and the
// pose that joins them in the hand-over band.
#ifndef SWARD_SHARED_BEND_H
#define SWARD_SHARED_BEND_H
#include "shared/types.h"

SHARED_BEGIN

// B3 as a continuum: (n, w), rise along the normal and shift along the wind at arc length s of a stem of length L bent by
// intensity I in [-1, 1]. k = (pi/2) I / L; series near k = 0. |(n, w)| <= s, and the curve's length is s.
SHARED_FN vec2 bend_arc(float s, float stem, float intensity) {
    float k = 0.5f * kPi * intensity / stem;
    float ks = k * s;
    if (abs(ks) < 1e-2f) { // next terms are ks^4 / 120 and ks^5 / 720: below float precision here
        return vec2(s * (1.0f - ks * ks / 6.0f), s * (0.5f * ks - ks * ks * ks / 24.0f));
    }
    return vec2(sin(ks) / k, (1.0f - cos(ks)) / k);
}

// Wind speed (m/s) to bend intensity. Saturates: blades reconfigure, they do not flatten (W6). `response` is 1 / (m/s).
SHARED_FN float bend_intensity(float speed_ms, float response) {
    return 0.72f * (1.0f - exp(-speed_ms * response));
}

// Displacement of the point at rest height y in a canopy of height `canopy` under the wind (m/s): the far tier's warp.
SHARED_FN vec3 bend_offset(float y, float canopy, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f || y <= 0.0f) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    vec2 arc = bend_arc(y, canopy, bend_intensity(speed, response));
    vec2 side = wind * (arc.y / speed);
    return vec3(side.x, arc.x - y, side.y);
}

// How that warp turns a stem at rest height y: its derivative along y, (sin, cos) of the bend with the wind's direction. A tangent
// (x, y, z) at rest becomes (x, 0, z) + y * this.
SHARED_FN vec3 bend_turn(float y, float canopy, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f) {
        return vec3(0.0f, 1.0f, 0.0f);
    }
    float angle = 0.5f * kPi * bend_intensity(speed, response) * y / canopy;
    vec2 side = wind * (sin(angle) / speed);
    return vec3(side.x, cos(angle), side.y);
}

// W3 for a point at rest height y of a stem of length L: offset (1 - lambda) T, T = F (Vx y^2, -|V| y^2, Vz y^2). As printed,
// (1 - lambda) T + lambda P' shrinks a calm blade to lambda of its height; here P' keeps its whole weight. F is chosen so
// that a stem's tip moves as far to the side as B3 moves it for the same intensity, to first order: both lean alike.
SHARED_FN vec3 grouped_offset(float y, float stem, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    float reach = 0.25f * kPi * bend_intensity(speed, response) / stem * y * y;
    vec2 side = wind * (reach / speed);
    return vec3(side.x, -0.5f * reach, side.y);
}

// J5.3: scales a Bezier (root at 0) back to its arc length. Gravesen's estimate of its present length.
SHARED_FN void keep_length(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, float arc_length) {
    float chord = length(v2);
    float polygon = length(v1) + length(v2 - v1);
    float k = arc_length / max((2.0f * chord + polygon) / 3.0f, 1e-6f);
    vec3 span = v2 - v1;
    v1 = v1 * k;
    v2 = v1 + span * k;
}

// A blade's posed control points. `toward_shell` 0: W3 and J5 (the near pose); 1: the very warp that bends its shell image.
SHARED_FN void pose_blade(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, vec4 stem_canopy_response_shell, vec2 wind) {
    float stem = stem_canopy_response_shell.x;
    float canopy = stem_canopy_response_shell.y;
    float response = stem_canopy_response_shell.z;
    vec3 near1 = v1 + grouped_offset(v1.y, stem, wind, response);
    vec3 near2 = v2 + grouped_offset(v2.y, stem, wind, response);
    keep_length(near1, near2, stem);
    // The warp moves the curve's points; a Bezier through the warped root, middle and tip is its closest quadratic.
    vec3 middle = 0.5f * v1 + 0.25f * v2;
    vec3 far2 = v2 + bend_offset(v2.y, canopy, wind, response);
    vec3 far_middle = middle + bend_offset(middle.y, canopy, wind, response);
    vec3 far1 = 2.0f * far_middle - 0.5f * far2;
    v1 = mix(near1, far1, stem_canopy_response_shell.w);
    v2 = mix(near2, far2, stem_canopy_response_shell.w);
}

SHARED_END
#endif
