// SPDX-License-Identifier: Apache-2.0
// What has passed through the grass (methods.md C1 to C4): one cell of the continuum, a step of it,
// and what presses it. The tracks' passes and their C++ twin call the same functions.
//
// `theta` is B3's intensity along x and z, so that it adds to what the wind bends: 1 is a tip at 90
// degrees. `omega` is its rate (1/s). `pressed` is the slow channel: where broken stems lie, and
// how much of them (0..1), as a vector along which they lie.
#ifndef SWARD_SHARED_TRACK_H
#define SWARD_SHARED_TRACK_H
#include "shared/track_field.h"
#include "shared/track_print.h"

SHARED_BEGIN

SHARED_CONST float kTrackStep_s = 1.0f / 60.0f;
SHARED_CONST float kMostBend = 1.0f; // of theta
SHARED_CONST float kLeastContact_m =
    0.03f;                              // C4's hc is never less: omega stays finite under a wheel
SHARED_CONST float kMostOmega = 200.0f; // 1/s

struct TrackCell {
    vec2 theta;
    vec2 omega;
    vec2 theta_step; // change in the last step
    vec2 omega_step;
};

// Greatest wave speed (m/s) that C2 is stable with: (1 - l/2) on the acceleration makes the paper's
// damping the central one, whose bound is 8 (c dt / h)^2 + k dt^2 <= 4 for every l in (0, 1]; k =
// 0: 1 / sqrt(2). A twentieth below it.
SHARED_FN float track_greatest_wave(float cell_m, float step_s, float k) {
    return 0.95f * cell_m / step_s * sqrt(max(4.0f - k * step_s * step_s, 0.0f) / 8.0f);
}

// C2: the next change of theta and omega from a cell and its four neighbours' (theta, omega). As
// printed, x(t+dt) = (2-l) x(t) - (1-l) x(t-dt)
// + a dt^2; with a (1 - l/2) waves run at c whatever l is. - k theta is ours.
SHARED_FN vec4 track_change(TrackRules rules, TrackCell own, vec4 west, vec4 east, vec4 north,
                            vec4 south) {
    float per_area = 1.0f / (rules.cell_m * rules.cell_m);
    vec4 sum = west + east + north + south;
    vec2 lap_theta = per_area * (vec2(sum.x, sum.y) - 4.0f * own.theta);
    vec2 lap_omega = per_area * (vec2(sum.z, sum.w) - 4.0f * own.omega);
    float c = min(rules.wave_mps + rules.wave_gain_m * length(own.omega), rules.most_wave_mps);
    float gain = (1.0f - 0.5f * rules.damping) * rules.step_s * rules.step_s;
    float kept = 1.0f - rules.damping;
    vec2 theta =
        kept * own.theta_step + gain * (c * c * lap_theta - rules.recovery_per_s2 * own.theta);
    vec2 omega =
        kept * own.omega_step + gain * (rules.rate_wave_mps * rules.rate_wave_mps * lap_omega -
                                        rules.recovery_per_s2 * own.omega);
    return vec4(theta.x, theta.y, omega.x, omega.y);
}

// The step itself: a cell whose change is known. Nothing leaves the range, nothing stays that is no
// number.
SHARED_FN TrackCell track_advance(TrackCell own, vec4 change) {
    TrackCell next = own;
    next.theta_step = vec2(change.x, change.y);
    next.omega_step = vec2(change.z, change.w);
    next.theta = own.theta + next.theta_step;
    next.omega = own.omega + next.omega_step;
    float bend = length(next.theta);
    float rate = length(next.omega);
    if (!(bend < 1e3f) || !(rate < 1e6f)) {
        next.theta = vec2(0.0f, 0.0f);
        next.omega = vec2(0.0f, 0.0f);
        next.theta_step = vec2(0.0f, 0.0f);
        next.omega_step = vec2(0.0f, 0.0f);
    } else if (bend > kMostBend) {
        next.theta = next.theta * (kMostBend / bend);
        next.theta_step = vec2(0.0f, 0.0f);
    }
    return next;
}

// How a print meets a cell in the step.
struct TrackContact {
    vec2 way;        // unit, C4's dir
    float speed;     // of the object along it (m/s)
    float clearance; // least height of its underside over the cell's ground (m)
    int touched;
};

// A place in a print's own frame: x to its right, z behind it.
SHARED_FN vec2 track_own(TrackPlace own, vec2 xz) {
    vec2 from = xz - own.place;
    return vec2(own.heading.x * from.x + own.heading.y * from.y,
                own.heading.x * from.y - own.heading.y * from.x);
}

// Part of the way from `from` by `way` inside |x| <= half.x, |y| <= half.y: (first, last) in 0..1;
// first > last: none.
SHARED_FN vec2 track_inside(vec2 from, vec2 way, vec2 half_size) {
    vec2 span = vec2(0.0f, 1.0f);
    for (int axis = 0; axis < 2; ++axis) {
        float at = axis == 0 ? from.x : from.y;
        float run = axis == 0 ? way.x : way.y;
        float reach = axis == 0 ? half_size.x : half_size.y;
        if (abs(run) < 1e-7f) {
            span = abs(at) <= reach ? span : vec2(1.0f, 0.0f);
        } else {
            float one = (-reach - at) / run;
            float two = (reach - at) / run;
            span = vec2(max(span.x, min(one, two)), min(span.y, max(one, two)));
        }
    }
    return span;
}

// Half sizes of a print to its right and behind it. None is narrower than a cell, or a strip would
// have gaps.
SHARED_FN vec2 track_half_size(TrackRules rules, TrackPrint print) {
    float wide = print.kind == kPrintSphere ? print.half_depth_m : print.half_width_m;
    return max(vec2(wide, print.half_depth_m), vec2(0.5f * rules.cell_m, 0.5f * rules.cell_m));
}

// Height of a print's underside over the ground at a place `own` in its frame, over that under its
// middle (m); negative: the place is not under it.
SHARED_FN float track_rise(TrackPrint print, vec2 own, vec2 half_size) {
    if (print.kind == kPrintBox) {
        return 0.0f;
    }
    float out_of = print.kind == kPrintSphere ? length(own) : abs(own.y);
    float square = half_size.y * half_size.y - out_of * out_of;
    return print.kind == kPrintSphere && out_of > half_size.x
               ? -1.0f
               : half_size.y - sqrt(max(square, 0.0f));
}

// M of C4 in a print's own frame: outward normal of the rim that is nearest; z: distance to that
// rim (m).
SHARED_FN vec3 track_rim(TrackPrint print, vec2 own, vec2 half_size) {
    if (print.kind == kPrintSphere) {
        float from_middle = length(own);
        return vec3(own.x / max(from_middle, 1e-6f), own.y / max(from_middle, 1e-6f),
                    half_size.x - from_middle);
    }
    vec2 inside = vec2(half_size.x - abs(own.x), half_size.y - abs(own.y));
    return inside.x < inside.y ? vec3(own.x < 0.0f ? -1.0f : 1.0f, 0.0f, inside.x)
                               : vec3(0.0f, own.y < 0.0f ? -1.0f : 1.0f, inside.y);
}

// C4's dir, and the object's speed along it (m/s): M + T on the rim that goes ahead, else T; of
// what stands, away from its middle.
SHARED_FN vec3 track_way(TrackRules rules, TrackPrint print, vec3 rim) {
    vec2 normal = vec2(print.now.heading.x * rim.x - print.now.heading.y * rim.y,
                       print.now.heading.y * rim.x + print.now.heading.x * rim.y);
    vec2 velocity = (print.now.place - print.before.place) / rules.step_s;
    float speed = length(velocity);
    vec2 ahead = speed > 1e-3f ? velocity / speed : vec2(0.0f, 0.0f);
    vec2 way = rim.z <= rules.cell_m && dot(normal, ahead) >= 0.0f ? ahead + normal : ahead;
    float length_of = length(way);
    if (length_of < 1e-3f) {
        way = normal;
        length_of = max(length(normal), 1e-6f);
    }
    way = way / length_of;
    return vec3(way.x, way.y, max(dot(velocity, way), 0.0f));
}

// C4 for one print and the cell around `xz` (from the page's corner). The print is swept by its way
// within the step: seen from it, the cell runs through its shape.
SHARED_FN TrackContact track_contact(TrackRules rules, TrackPrint print, vec2 xz) {
    TrackContact contact;
    contact.touched = 0;
    contact.way = vec2(0.0f, 0.0f);
    contact.speed = 0.0f;
    contact.clearance = 0.0f;
    vec2 half_size = track_half_size(rules, print);
    vec2 from = track_own(print.before, xz);
    vec2 run = track_own(print.now, xz) - from;
    vec2 span = track_inside(from, run, half_size);
    if (span.x > span.y) {
        return contact;
    }
    // Where the underside is nearest: straight over the middle, or as near as it comes.
    bool ball = print.kind == kPrintSphere;
    float square = max(ball ? dot(run, run) : run.y * run.y, 1e-12f);
    float nearest = clamp(-(ball ? dot(from, run) : from.y * run.y) / square, span.x, span.y);
    vec2 own = from + run * nearest;
    float rise = track_rise(print, own, half_size);
    contact.clearance = max(print.underside_m + rise, 0.0f);
    if (rise < 0.0f || contact.clearance >= rules.canopy_m) {
        return contact;
    }
    vec3 way = track_way(rules, print, track_rim(print, own, half_size));
    contact.way = vec2(way.x, way.y);
    contact.speed = way.z;
    contact.touched = 1;
    return contact;
}

// Bend (B3) that takes a canopy's tip down to a height over the canopy's: sin(x) / x of x = pi/2 I,
// near enough.
SHARED_FN float track_needed(float height_share) {
    return min(0.63662f * sqrt(6.0f * max(1.0f - height_share, 0.0f)), kMostBend);
}

// Greatest bend toward `way` on a slope (dy/dx, dy/dz): uphill the ground comes up (C1).
SHARED_FN float track_most(vec2 slope, vec2 way) {
    return kMostBend * (1.0f - atan(max(dot(slope, way), 0.0f)) * (2.0f / kPi));
}

// C1 and C4 for a cell that a print touches: omega = dir s cos^2(theta) / hc, theta += |omega| dt.
// Whatever the speed, the grass ends under the object: that is what a strip's width follows from.
// Held, it does not move by itself.
SHARED_FN TrackCell track_bent(TrackRules rules, TrackCell own, TrackContact contact, vec2 slope) {
    TrackCell next = own;
    float upright = cos(0.5f * kPi * min(length(own.theta), 1.0f));
    float rate =
        contact.speed * upright * upright / max(contact.clearance, kLeastContact_m) * (2.0f / kPi);
    next.omega = contact.way * min(rate, kMostOmega);
    next.theta = own.theta + next.omega * rules.step_s;
    float along = dot(next.theta, contact.way);
    float needed = track_needed(contact.clearance / rules.canopy_m);
    next.theta = next.theta + contact.way * max(needed - along, 0.0f);
    float most = track_most(slope, next.theta / max(length(next.theta), 1e-6f));
    next.theta = next.theta * min(1.0f, most / max(length(next.theta), 1e-6f));
    next.theta_step = vec2(0.0f, 0.0f);
    next.omega_step = vec2(0.0f, 0.0f);
    return next;
}

// The slow channel under a print: by its load and height alone, so that speed leaves no mark in it.
// Counted in units of rules.left.
SHARED_FN vec2 track_pressed(TrackRules rules, vec2 pressed, TrackContact contact, float load) {
    float depth = 1.0f - contact.clearance / rules.canopy_m;
    float now = rules.broken * load * smoothstep(0.25f, 0.9f, depth) / rules.left;
    float there = length(pressed);
    if (now <= 0.5f * there) { // brushed: those that lie stay
        return pressed;
    }
    return contact.way * max(now, there);
}

// What is left of `pressed` after a time, as stems rise in their own: 1/e after `lasting`.
SHARED_FN float track_left(float seconds, float lasting_s) {
    return exp(-seconds / lasting_s);
}

SHARED_END
#endif
