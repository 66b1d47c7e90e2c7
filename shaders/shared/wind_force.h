// SPDX-License-Identifier: Apache-2.0
// What pushes the air in the window: arrows (methods.md W5), analytic sources (J4, C5). One
// function says what a force wants at a place; the passes of shaders/wind/ and the tests ask it
// alike.
#ifndef SWARD_SHARED_WIND_FORCE_H
#define SWARD_SHARED_WIND_FORCE_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kForceDisc = 0;   // arrow: a disc
SHARED_CONST int kForceStrip = 1;  // jet: a strip from its place along its direction
SHARED_CONST int kForceWake = 2;   // air dragged along behind a vehicle that heads in its direction
SHARED_CONST int kForceRing = 3;   // rotor, fan: out from a point
SHARED_CONST int kForceVortex = 4; // cyclone: around a point and into it
SHARED_CONST int kForceWave = 5;   // directional moving sines

// 64 bytes.
struct WindForce {
    vec2 place; // x, z from the window's north-west corner (m)
    vec2 along; // unit direction x, z
    float
        radius_m;  // disc, strip, wake: half width; ring, vortex: of the highest speed; wave: reach
    float reach_m; // or length (strip, wake)
    float speed_mps;
    float rate_per_s;
    vec2 velocity;     // of a vortex itself x, z (m/s)
    float wave_number; // of a wave (rad/m)
    float wave_phase;  // at its place (rad)
    int kind;          // kForce*
    float inflow; // of a vortex, over its tangential speed; its sign is the turn (+ clockwise from
                  // above)
    int unused_a, unused_b; // to 64 bytes
};
#ifdef __cplusplus
static_assert(sizeof(WindForce) == 64);
#endif

// What a force wants at a place.
struct WindPush {
    vec2 target;  // velocity that the air relaxes to (m/s)
    float rate;   // how fast (1/s); 0: not at all
    vec2 outflow; // velocity field whose divergence is air that comes from above or leaves upwards
                  // (m/s)
};

// 1 in the middle, 0 with zero slope from the rim on.
SHARED_FN float force_weight(float share_of_radius) {
    float inside = max(1.0f - share_of_radius * share_of_radius, 0.0f);
    return inside * inside;
}

// Lamb-Oseen: rises linearly in the core, is 1 at s = 1 and falls as 1 / s. The radial wall jet
// below a rotor has much the same profile (Poreh, Tsuei and Cermak measured a fall by r^-1.1).
SHARED_FN float ring_profile(float s) {
    if (s < 1e-3f)
        return 1.756f * s;
    return 1.39795f * (1.0f - exp(-1.25643f * s * s)) / s;
}

// Share of a radial or tangential wind that is left at a distance: whole out to half its reach.
SHARED_FN float reach_weight(float distance_m, float reach_m) {
    return 1.0f - smoothstep(0.5f * reach_m, reach_m, distance_m);
}

// Moving sines, -1..1: one gust front a wavelength, its rise steeper than its fall.
SHARED_FN float wave_profile(float phase) {
    return 0.6f * sin(phase) + 0.25f * sin(2.0f * phase + 1.1f) + 0.15f * sin(3.0f * phase + 2.3f);
}

// Speed of a wake, 0..1, and its half width over that at the vehicle, `behind` half widths behind
// it: momentum is kept as an axisymmetric wake widens, u ~ x^-2/3, b ~ x^1/3 (Schlichting).
SHARED_FN vec2 wake_at(float behind) {
    float grown = pow(1.0f + 0.25f * max(behind, 0.0f), 1.0f / 3.0f);
    return vec2(1.0f / (grown * grown), grown);
}

SHARED_FN WindPush wind_force_at(WindForce force, vec2 xz) {
    WindPush push;
    push.target = vec2(0.0f, 0.0f);
    push.rate = 0.0f;
    push.outflow = vec2(0.0f, 0.0f);
    int kind = force.kind;
    float speed = force.speed_mps;
    vec2 along = force.along;
    vec2 from = xz - force.place;
    float distance_m = length(from);
    float radius = force.radius_m;
    if (kind == kForceDisc) {
        push.target = along * speed;
        push.rate = force.rate_per_s * force_weight(distance_m / radius);
    } else if (kind == kForceStrip) {
        float ahead = dot(from, along);
        vec2 off = from - along * clamp(ahead, 0.0f, force.reach_m);
        push.target = along * speed;
        push.rate = force.rate_per_s * force_weight(length(off) / radius);
    } else if (kind == kForceWake) {
        float behind = -dot(from, along);
        vec2 shape = wake_at(behind / radius);
        float aside = length(from + along * behind) / (radius * shape.y);
        float ends = smoothstep(-radius, 0.0f, behind) *
                     (1.0f - smoothstep(0.5f * force.reach_m, force.reach_m, behind));
        push.target = along * (speed * shape.x);
        push.rate = force.rate_per_s * ends * force_weight(0.5f * aside);
    } else if (kind == kForceRing) {
        float profile =
            speed * ring_profile(distance_m / radius) * reach_weight(distance_m, force.reach_m);
        push.outflow = from * (profile / max(distance_m, 1e-6f));
    } else if (kind == kForceVortex) {
        float weight = reach_weight(distance_m, force.reach_m);
        vec2 outwards = from / max(distance_m, 1e-6f);
        vec2 around = vec2(-outwards.y, outwards.x) *
                      (force.inflow < 0.0f ? -1.0f : 1.0f); // x east, z south: clockwise
        float profile = speed * ring_profile(distance_m / radius);
        push.outflow = outwards * (-abs(force.inflow) * profile * weight);
        push.target = around * profile + push.outflow + force.velocity;
        push.rate = force.rate_per_s * weight;
    } else {
        float profile = wave_profile(force.wave_number * dot(from, along) + force.wave_phase) *
                        reach_weight(distance_m, force.reach_m);
        push.outflow = along * (speed * profile);
    }
    return push;
}

// Velocity of air that several forces push for `step_s`: a mean of what it was and what each wants,
// weighted by their rates, so that it comes near a target and never passes it. `wanted`: sum of
// rate * target; `rate`: sum of rates.
SHARED_FN float relaxed(float speed, float wanted, float rate, float step_s) {
    return (speed + wanted * step_s) / (1.0f + rate * step_s);
}

SHARED_END
#endif
