// SPDX-License-Identifier: Apache-2.0
// How grass bends: the closed form of B3 for shells and slices, W3 for grouped blades, J5 to keep a
// blade's length, and the pose that joins them in the hand-over band.
#ifndef SWARD_SHARED_BEND_H
#define SWARD_SHARED_BEND_H
#include "shared/hash.h"
#include "shared/types.h"

SHARED_BEGIN

// B3 as a continuum: (n, w), rise along the normal and shift along the wind at arc length s of a
// stem of length L bent by intensity I in [-1, 1]. k = (pi/2) I / L; series near k = 0. |(n, w)| <=
// s, and the curve's length is s.
SHARED_FN vec2 bend_arc(float s, float stem, float intensity) {
    float k = 0.5f * kPi * intensity / stem;
    float ks = k * s;
    if (abs(ks) < 1e-2f) { // next terms are ks^4 / 120 and ks^5 / 720: below float precision here
        return vec2(s * (1.0f - ks * ks / 6.0f), s * (0.5f * ks - ks * ks * ks / 24.0f));
    }
    return vec2(sin(ks) / k, (1.0f - cos(ks)) / k);
}

// Load of the wind on grass over its stiffness (Cauchy number, scaled): `response` is 1 / (m/s).
// The square is drag's.
SHARED_FN float wind_load(float speed_mps, float response) {
    float x = speed_mps * response;
    return x * x;
}

// Wind speed (m/s) to bend intensity (W6). An elastic fibre clamped in a cross flow turns its tip
// by 90 degrees * I; drag on what it still holds against the wind is all that bends it further, so
// I starts as 2/3 of the load and nears 1 as load^(-2/3): blades reconfigure, they do not flatten.
// Within 0.06 of the fibre's own curve, integrated (tests). In [0, 1): a canopy keeps 2 / pi of its
// height.
SHARED_FN float bend_intensity(float speed_mps, float response) {
    return 1.0f - pow(1.0f + wind_load(speed_mps, response), -2.0f / 3.0f);
}

// Displacement of the point at rest height y in a canopy of height `canopy` under the wind (m/s):
// the far tier's warp.
SHARED_FN vec3 bend_offset(float y, float canopy, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f || y <= 0.0f) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    vec2 arc = bend_arc(y, canopy, bend_intensity(speed, response));
    vec2 side = wind * (arc.y / speed);
    return vec3(side.x, arc.x - y, side.y);
}

// How that warp turns a stem at rest height y: its derivative along y, (sin, cos) of the bend with
// the wind's direction. A tangent (x, y, z) at rest becomes (x, 0, z) + y * this.
SHARED_FN vec3 bend_turn(float y, float canopy, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f) {
        return vec3(0.0f, 1.0f, 0.0f);
    }
    float angle = 0.5f * kPi * bend_intensity(speed, response) * y / canopy;
    vec2 side = wind * (sin(angle) / speed);
    return vec3(side.x, cos(angle), side.y);
}

// Rest heights over the canopy's: where the bend stands for the whole canopy's, to its light and to
// the tiers' shares of it.
SHARED_CONST float kSwayHeight = 0.45f;
SHARED_CONST float kLeanHeight = 0.65f;

// W3 for a point at rest height y of a stem: offset (1 - lambda) T, T = F (Vx y^2, -|V| y^2, Vz
// y^2). As printed, (1 - lambda) T + lambda P' shrinks a calm blade to lambda of its height; here
// P' keeps its whole weight. F, one number for the shift and one for the fall, puts an upright
// stem's tip where B3 puts it in the canopy: both lean alike in every wind.
SHARED_FN vec3 grouped_offset(float y, vec2 stem_canopy, vec2 wind, float response) {
    float speed = length(wind);
    if (speed < 1e-4f) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    float stem = stem_canopy.x;
    vec2 tip = bend_arc(stem, stem_canopy.y, bend_intensity(speed, response));
    float share = y * y / (stem * stem);
    vec2 side = wind * (tip.y * share / speed);
    return vec3(side.x, (tip.x - stem) * share, side.y);
}

// J5.3: scales a Bezier (root at 0) back to its arc length. Gravesen's estimate of its present
// length.
SHARED_FN void keep_length(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, float arc_length) {
    float chord = length(v2);
    float polygon = length(v1) + length(v2 - v1);
    float k = arc_length / max((2.0f * chord + polygon) / 3.0f, 1e-6f);
    vec3 span = v2 - v1;
    v1 = v1 * k;
    v2 = v1 + span * k;
}

// Time enters flutter as the fraction of this period, reduced in double on the CPU; every frequency
// is a whole number of cycles in it, so that motion is as fine after days as at the start, and has
// no seam.
SHARED_CONST float kFlutterPeriod_s = 64.0f;

// Cycles in kFlutterPeriod_s of a blade's first bending mode: a cantilever's frequency falls with
// the square of its length and rises with the root of its stiffness (0 limp .. 1 stiff). 2.6 Hz at
// 0.27 m and 0.6.
SHARED_FN float flutter_cycles(float stem, float stiffness) {
    float hz = 0.19f / (stem * stem) * sqrt((stiffness + 0.2f) / 0.8f);
    return floor(kFlutterPeriod_s * clamp(hz, 0.7f, 9.0f) + 0.5f);
}

// Amplitude of flutter at the tip over the blade's length: as the load at first, saturating (W6).
SHARED_FN float flutter_amplitude(float speed_mps, float response) {
    float load = wind_load(speed_mps, response);
    return 0.17f * load / (1.0f + load);
}

// What flutter does to a blade: shift of the tip over its length, along and across the wind, and
// turn of its facing (rad). A function of the time (in kFlutterPeriod_s, fraction), the blade
// (length, stiffness, rank, seed) and the wind alone. Bursts of a few seconds swell and fade;
// across, a blade is off its own beat, so that its tip draws loops.
SHARED_FN vec3 flutter_at(float time, vec4 stem_stiffness_rank_seed, float amplitude) {
    uint h = hash_pcg(uint(stem_stiffness_rank_seed.z * 256.0f) * 256u +
                      uint(stem_stiffness_rank_seed.w * 256.0f) + 0xf1a7u);
    float phase = float(h & 1023u) / 1024.0f;
    float other = float((h >> 10u) & 1023u) / 1024.0f;
    // 15 percent either way: blades of one length do not beat together
    float cycles = floor(flutter_cycles(stem_stiffness_rank_seed.x, stem_stiffness_rank_seed.y) *
                             (0.85f + 0.3f * float((h >> 20u) & 255u) / 256.0f) +
                         0.5f);
    float slow = 9.0f + float((h >> 28u) & 15u); // 0.14 to 0.38 Hz
    float burst = 0.65f + 0.35f * sin(2.0f * kPi * (fract(slow * time) + other));
    float along = sin(2.0f * kPi * (fract(cycles * time) + phase));
    float across = sin(2.0f * kPi * (fract(floor(0.83f * cycles) * time) + other));
    float twist = sin(2.0f * kPi * (fract(floor(1.37f * cycles) * time) + phase + other));
    return amplitude * burst * vec3(along, 0.35f * across, 2.2f * twist);
}

// Flutter of a posed blade about its pose; J5 keeps its length. `shift`: along and across the wind,
// over the length.
SHARED_FN void flutter_blade(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, float stem, vec2 shift,
                             vec2 wind) {
    vec2 ahead = wind / max(length(wind), 1e-4f);
    vec2 side = stem * (shift.x * ahead + shift.y * vec2(-ahead.y, ahead.x));
    // Square to the blade's own chord, or a blade that points along the wind would only be
    // stretched and shortened again.
    vec3 chord = normalize(v2 + vec3(0.0f, 1e-6f, 0.0f));
    vec3 push = vec3(side.x, 0.0f, side.y);
    vec3 swing = push - chord * dot(push, chord);
    swing = swing * (length(push) / max(length(swing), 0.4f * length(push) + 1e-9f));
    v2 = v2 + swing;
    v1 = v1 + 0.2f * swing; // the first mode, near s^2
    keep_length(v1, v2, stem);
}

// The near pose without state: W3 and J5.
SHARED_FN void grouped_pose(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, vec3 stem_canopy_response,
                            vec2 wind) {
    float stem = stem_canopy_response.x;
    vec2 stem_canopy = vec2(stem, stem_canopy_response.y);
    v1 = v1 + grouped_offset(v1.y, stem_canopy, wind, stem_canopy_response.z);
    v2 = v2 + grouped_offset(v2.y, stem_canopy, wind, stem_canopy_response.z);
    keep_length(v1, v2, stem);
}

// The very warp that bends a blade's shell image.
SHARED_FN void shell_pose(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2, float canopy,
                          float response, vec2 wind) {
    // The warp moves the curve's points; a Bezier through the warped root, middle and tip is its
    // closest quadratic.
    vec3 middle = 0.5f * v1 + 0.25f * v2;
    v2 = v2 + bend_offset(v2.y, canopy, wind, response);
    middle = middle + bend_offset(middle.y, canopy, wind, response);
    v1 = 2.0f * middle - 0.5f * v2;
}

// A grouped blade's posed control points. `shell` 0: the near pose; 1: the shell image's.
SHARED_FN void pose_blade(SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2,
                          vec4 stem_canopy_response_shell, vec2 wind) {
    vec3 near1 = v1;
    vec3 near2 = v2;
    grouped_pose(near1, near2, vec3(stem_canopy_response_shell), wind);
    shell_pose(v1, v2, stem_canopy_response_shell.y, stem_canopy_response_shell.z, wind);
    v1 = mix(near1, v1, stem_canopy_response_shell.w);
    v2 = mix(near2, v2, stem_canopy_response_shell.w);
}

SHARED_END
#endif
