// SPDX-License-Identifier: Apache-2.0
// A blade that lives: one fixed step of it (J4), what keeps it a blade (J5) and what pushes it
// (J6). The physics pass and its C++ twin run these functions. All places are relative to the root;
// the state is what J4's force map holds: xyz the tip's offset from its calm place, w the collision
// memory eta. All zeros: calm.
#ifndef SWARD_SHARED_BLADE_PHYSICS_H
#define SWARD_SHARED_BLADE_PHYSICS_H
#include "shared/bend.h"
#include "shared/blade.h"
#include "shared/blade_step.h"

SHARED_BEGIN

// A blade as a step sees it. `calm1`, `calm2`: control points in still air, the equilibrium of
// recovery and gravity.
struct BladeBody {
    vec3 up; // unit, away from the ground
    vec3 calm1;
    vec3 calm2;
    vec3 gravity;     // J4's g (m/s)
    vec2 stem_canopy; // length of the calm curve, the canopy's height (m)
    float recovery;   // J4's s (1/s)
    float response;   // of W6, 1 / (m/s)
};

SHARED_CONST float kLeastStem_m = 1e-4f; // shorter blades do not move
SHARED_CONST float kMemoryLoss = 0.2f;   // eta / s
SHARED_CONST float kMemoryGain = 15.0f;
SHARED_CONST float kMemoryMost = 2.0f; // what no crowd of colliders takes eta past: no trail stays
                                       // longer than 10 s and a fall back
SHARED_CONST float kLeastRecovery = 0.1f;    // J4's share of recovery while eta is full
SHARED_CONST float kStandardGravity = 9.81f; // m/s^2
SHARED_CONST int kCollisionRounds = 16;      // J6 and J5 in turn, until nothing is inside

// A step under gravity that draws straight down.
SHARED_FN BladeStep plain_blade_step(float step_s, float canopy, float response) {
    BladeStep rules;
    rules.down = vec3(0.0f, -1.0f, 0.0f);
    rules.gravity_mps2 = kStandardGravity;
    rules.centre = vec3(0.0f, 0.0f, 0.0f);
    rules.centre_mps2 = 0.0f;
    rules.memory_loss = kMemoryLoss;
    rules.memory_gain = kMemoryGain;
    rules.memory_most = kMemoryMost;
    rules.centre_share = 0.0f;
    rules.step_s = step_s;
    rules.canopy_m = canopy;
    rules.response = response;
    rules.run_up = 0;
    return rules;
}

// J4's s by stiffness, 0 limp .. 1 stiff: 1/e of a push is left after 0.33 .. 0.11 s.
SHARED_FN float blade_recovery(float stiffness) {
    return 3.0f + 6.0f * stiffness;
}

// W6's response of one blade by its stiffness, 1 / (m/s).
SHARED_FN float blade_response(float stiffness) {
    return 0.23f * (1.3f - stiffness);
}

// Length of a quadratic Bezier (root at 0): Gravesen's estimate on its quarters. Within 1 % for
// every v1 and v2 that J5.2 leaves (tests); on the whole curve, as printed, it is up to 30 % short
// where a tip is pushed to its root.
SHARED_FN float bezier_length(vec3 v1, vec3 v2) {
    vec3 turn = v2 - 2.0f * v1; // half of what the derivative gains from root to tip
    vec3 a = blade_curve(v1, v2, 0.25f);
    vec3 b = blade_curve(v1, v2, 0.5f);
    vec3 c = blade_curve(v1, v2, 0.75f);
    float chords = length(a) + length(b - a) + length(c - b) + length(v2 - c);
    float legs =
        0.25f * (length(v1) + length(v1 + turn)) +
        0.5f * (length(v1 + 0.25f * turn) + length(v1 + 0.5f * turn) + length(v1 + 0.75f * turn));
    return (2.0f * chords + legs) / 3.0f;
}

// J4's g: environmental and front gravity. `mobility` (s): its speed under a weight of 1 m/s^2;
// recovery * length * sag / 9.81 pulls the tip by `sag` of its length from where recovery alone
// would hold it. `front`: unit, square to the width direction.
SHARED_FN vec3 blade_gravity(BladeStep rules, vec3 root, vec3 front, float mobility) {
    vec3 to_centre = rules.centre - root;
    vec3 drawn = to_centre * (rules.centre_mps2 / max(length(to_centre), 1e-6f));
    vec3 down = rules.down * rules.gravity_mps2;
    vec3 environment = mobility * mix(down, drawn, rules.centre_share);
    return environment + 0.25f * length(environment) * front;
}

// A body but for its gravity: what a pose needs.
SHARED_FN BladeBody blade_shape(vec3 up, vec3 calm1, vec3 calm2, float stiffness, float canopy) {
    BladeBody body;
    body.up = up;
    body.calm1 = calm1;
    body.calm2 = calm2;
    body.gravity = vec3(0.0f, 0.0f, 0.0f);
    body.stem_canopy = vec2(bezier_length(calm1, calm2), canopy);
    body.recovery = blade_recovery(stiffness);
    body.response = blade_response(stiffness);
    return body;
}

// A set's blade stands on ground that faces up.
SHARED_FN BladeBody set_blade_shape(BladeRecord blade, float canopy) {
    return blade_shape(vec3(0.0f, 1.0f, 0.0f), vec3(blade.v1.x, blade.v1.y, blade.v1.z),
                       vec3(blade.v2.x, blade.v2.y, blade.v2.z), blade.v2.w, canopy);
}

// Its baked curve is its calm pose, so gravity shows only where recovery is weak.
SHARED_FN BladeBody set_blade_body(BladeStep rules, BladeRecord blade, vec3 root) {
    BladeBody body = set_blade_shape(blade, rules.canopy_m);
    vec3 width = blade_width_direction(blade.shape.x);
    vec3 front = vec3(-width.z, 0.0f, width.x);
    front = dot(front, body.calm2) < 0.0f ? -front : front;
    float sag = 0.03f + 0.05f * blade.shape.z; // of its length, by its droop
    body.gravity = blade_gravity(rules, root, front,
                                 body.recovery * body.stem_canopy.x * sag / kStandardGravity);
    return body;
}

// J5.2: v1 stands over the root, lower the farther the tip is out. Its least height is 0.035 of the
// blade, not 0.05: so that one that lies under a body is inside it by less than 2 % of its length.
SHARED_FN vec3 upright_middle(BladeBody body, vec3 v2) {
    float out_share = length(v2 - body.up * dot(v2, body.up)) / body.stem_canopy.x;
    return body.up * (body.stem_canopy.x * max(1.0f - out_share, 0.035f * max(out_share, 1.0f)));
}

// J5 after every displacement of the tip: over the ground, v1, length. The printed v1 suits blades
// that rest upright; what the calm curve has else is added, and fades as the tip leaves its calm
// place.
SHARED_FN vec3 settle_blade(BladeBody body, SHARED_INOUT(vec3) v2) {
    float stem = body.stem_canopy.x;
    v2 = v2 - body.up * min(dot(v2, body.up), 0.0f);
    float near_calm = 1.0f - smoothstep(0.0f, 0.75f, length(v2 - body.calm2) / stem);
    vec3 v1 =
        upright_middle(body, v2) + near_calm * (body.calm1 - upright_middle(body, body.calm2));
    v1 = v1 - body.up * min(dot(v1, body.up), 0.0f);
    float k = stem / max(bezier_length(v1, v2), 1e-3f * stem);
    v2 = v2 * k; // v1' + k (v2 - v1)
    return v1 * k;
}

// Drag (m/s) on an upright blade that J4 holds in balance where W6 and B3 put its tip: at the angle
// a from upright, J5.3 takes what acts along the blade, so s stem tan a = drag * fd * fr with fd =
// 1 - sin a, fr = rise / stem.
SHARED_FN float blade_drag(BladeBody body, float speed_mps) {
    float stem = body.stem_canopy.x;
    vec2 tip =
        bend_arc(stem, max(body.stem_canopy.y, stem), bend_intensity(speed_mps, body.response));
    float lean = tip.y / tip.x;
    float along = lean / sqrt(1.0f + lean * lean); // sin a
    return body.recovery * stem * stem * lean / ((1.0f - along) * tip.x);
}

// J4's w (m/s): wind (m/s) in the plane that the blade stands on.
SHARED_FN vec3 blade_wind(BladeBody body, vec3 v2, vec3 wind) {
    vec3 flat_wind = wind - body.up * dot(wind, body.up);
    float speed = length(flat_wind);
    if (speed < 1e-4f) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    vec3 ahead = flat_wind / speed;
    float fd = 1.0f - min(abs(dot(ahead, v2)) / max(length(v2), 1e-6f), 1.0f);
    float fr = max(dot(v2, body.up), 0.0f) / body.stem_canopy.x;
    return ahead * (blade_drag(body, speed) * fd * fr);
}

// Nearest place of a sphere's centre to a point on its way from `before` to `now` within the step.
SHARED_FN vec3 sweep_nearest(vec3 point, vec3 now, vec3 before) {
    vec3 way = now - before;
    return before + way * clamp(dot(point - before, way) / max(dot(way, way), 1e-12f), 0.0f, 1.0f);
}

// J6: shift that takes a point out of what a sphere sweeps in the step.
SHARED_FN vec3 sphere_push(vec3 point, vec3 now, vec3 before, float radius) {
    vec3 away = point - sweep_nearest(point, now, before);
    float apart = length(away);
    if (apart >= radius) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    return apart > 1e-6f ? away * (radius / apart - 1.0f) : vec3(0.0f, radius, 0.0f);
}

// Whether a sphere could touch a blade at all: against the ball about the root's and the tip's
// middle that holds the curve.
SHARED_FN bool sphere_is_near(vec3 v1, vec3 v2, vec4 now_radius, vec3 before) {
    vec3 middle = 0.5f * v2;
    float reach = now_radius.w + max(length(middle), length(v1 - middle));
    vec3 away = middle - sweep_nearest(middle, vec3(now_radius), before);
    return dot(away, away) < reach * reach;
}

// J6 for one sphere (centres relative to the root): the tip, the curve's middle, whose shift acts
// on the tip times 4, and its points at 3/4 and 1/4 likewise. What the ground or the blade's length
// would take from a push is turned along the ground, outward, and aside: blades under a body lie
// down. Then J5. True where it pushed by more than a hundred-thousandth of the blade's length.
SHARED_FN bool collide_blade(BladeBody body, SHARED_INOUT(vec3) v1, SHARED_INOUT(vec3) v2,
                             vec4 now_radius, vec3 before) {
    vec3 now = vec3(now_radius);
    float stem = body.stem_canopy.x;
    vec3 tip = sphere_push(v2, now, before, now_radius.w);
    vec3 high = 1.7778f * sphere_push(blade_curve(v1, v2, 0.75f), now, before, now_radius.w);
    vec3 middle = 4.0f * sphere_push(blade_curve(v1, v2, 0.5f), now, before, now_radius.w);
    vec3 low = 8.0f * sphere_push(blade_curve(v1, v2, 0.25f), now, before, now_radius.w);
    // Their mean, weighted by themselves: near the greatest. The sum, as printed, throws a blade
    // well out of a body that holds all of it.
    vec4 far = vec4(length(tip), length(high), length(middle), length(low));
    float sum = far.x + far.y + far.z + far.w;
    if (sum <= 0.0f) {
        return false;
    }
    vec3 push = (far.x * tip + far.y * high + far.z * middle + far.w * low) / sum;
    float pushed = length(push);
    // What would push the blade together, J5.3 takes back: it swings aside instead.
    vec3 chord = v2 / max(length(v2), 1e-6f);
    vec3 aside = push - chord * min(dot(push, chord), 0.0f);
    push = aside * (pushed / max(length(aside), 0.25f * pushed));
    push = push * min(1.0f, stem / pushed); // a root inside a body: never by more than the blade
    v2 = v2 + push;
    float under = max(-dot(v2, body.up), 0.0f);
    vec3 out_way = v2 - body.up * dot(v2, body.up);
    v2 = v2 + out_way * (under / max(length(out_way), 1e-6f));
    settle_blade(body, v2);
    v1 = settle_blade(body, v2); // after a long push once is not enough: v1 follows from where the
                                 // first has put the tip
    return pushed > 1e-5f * stem;
}

// How far a blade is inside a sphere (m): at its tip and two points of its curve, 0 where it is
// free.
SHARED_FN float blade_depth(vec3 v1, vec3 v2, vec4 now_radius) {
    vec3 now = vec3(now_radius);
    float nearest = min(length(v2 - now), min(length(blade_curve(v1, v2, 0.5f) - now),
                                              length(blade_curve(v1, v2, 0.75f) - now)));
    return max(now_radius.w - nearest, 0.0f);
}

// J4 without collisions, and J5: moves the tip by one step. eta falls; recovery is weaker while it
// lasts. The tip's rest place is calm2 - g / s, so that recovery and gravity balance in the calm
// pose: r + g = g (1 - k) - s k (v2 - calm2).
SHARED_FN vec3 move_blade(BladeStep rules, BladeBody body, vec3 wind, SHARED_INOUT(vec3) v2,
                          SHARED_INOUT(float) eta) {
    eta = max(eta - rules.memory_loss * rules.step_s, 0.0f);
    float k = max(1.0f - eta, kLeastRecovery);
    vec3 rate = (1.0f - k) * body.gravity - (body.recovery * k) * (v2 - body.calm2) +
                blade_wind(body, v2, wind);
    v2 = v2 + rate * rules.step_s;
    return settle_blade(body, v2);
}

// What J6 adds to eta for a shift of the tip by all colliders of a step.
SHARED_FN float remember_push(BladeStep rules, BladeBody body, vec3 push, float eta) {
    float part = length(push) / body.stem_canopy.x;
    return min(eta + rules.memory_gain * part * part, max(rules.memory_most, eta));
}

// The tip that a state means; calm for one that no blade can be in (NaN, infinite, farther than the
// blade is long).
SHARED_FN vec3 state_tip(BladeBody body, SHARED_INOUT(vec4) state) {
    vec3 offset = vec3(state.x, state.y, state.z);
    float most = 3.0f * body.stem_canopy.x;
    if (!(dot(offset, offset) <= most * most) || !(state.w >= 0.0f && state.w <= 1e6f)) {
        state = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        offset = vec3(0.0f, 0.0f, 0.0f);
    }
    return body.calm2 + offset;
}

// A blade that moves at all, and a wind that is one.
SHARED_FN bool blade_moves(BladeBody body) {
    return body.stem_canopy.x >= kLeastStem_m;
}
SHARED_FN vec3 checked_wind(vec3 wind) {
    return dot(wind, wind) < 1e6f ? wind : vec3(0.0f, 0.0f, 0.0f);
}

// State of a blade that stands in the grouped pose (W3): how one begins. `wind` (m/s) in space;
// what of it goes along the ground bends.
SHARED_FN vec4 leaning_state(BladeBody body, vec3 wind, float response) {
    float stem = body.stem_canopy.x;
    if (stem < kLeastStem_m) {
        return vec4(0.0f, 0.0f, 0.0f, 0.0f);
    }
    vec3 along = wind - body.up * dot(wind, body.up);
    float speed = length(along);
    vec3 v2 = body.calm2;
    if (speed >= 1e-4f) {
        vec3 bend = grouped_offset(dot(v2, body.up), vec2(stem, max(body.stem_canopy.y, stem)),
                                   vec2(speed, 0.0f), response);
        v2 = v2 + along * (bend.x / speed) + body.up * bend.y;
    }
    settle_blade(body, v2);
    return vec4(v2 - body.calm2, 0.0f);
}
SHARED_FN vec4 grouped_state(BladeBody body, vec2 wind, float response) {
    return leaning_state(body, vec3(wind.x, 0.0f, wind.y), response);
}

// Control points that a state stands for: what is drawn.
SHARED_FN void simulated_pose(BladeBody body, vec4 state, SHARED_OUT(vec3) v1,
                              SHARED_OUT(vec3) v2) {
    v1 = body.calm1;
    v2 = body.calm2;
    if (blade_moves(body)) {
        v2 = body.calm2 + vec3(state.x, state.y, state.z);
        v1 = settle_blade(body, v2);
    }
}

// Seconds until a push has fallen to `part` of itself with this eta at its end, in still air and no
// gravity: J4's recovery, first at kLeastRecovery of s while eta is over 0.9, then faster as eta
// goes, then at s.
SHARED_FN float recovery_time(float recovery, float eta, float loss, float part) {
    float left =
        -log(part) / recovery; // integral of max(1 - eta, kLeastRecovery) over time that is needed
    float held = max(eta - (1.0f - kLeastRecovery), 0.0f) / loss;
    if (left <= kLeastRecovery * held) {
        return left / kLeastRecovery;
    }
    left = left - kLeastRecovery * held;
    float start =
        max(1.0f - min(eta, 1.0f - kLeastRecovery), 0.0f); // share of recovery at the ramp's start
    float ramp = (1.0f - start) / loss;
    float over_ramp = 0.5f * (start + 1.0f) * ramp;
    if (left <= over_ramp) {
        return held + (sqrt(start * start + 2.0f * loss * left) - start) / loss;
    }
    return held + ramp + left - over_ramp;
}

SHARED_END
#endif
