// SPDX-License-Identifier: Apache-2.0
// What is seen of what has passed: cells and footprints of many, how they add to the wind, what
// that does to heights and light. One for every tier.
#ifndef SWARD_SHARED_TRACK_SEEN_H
#define SWARD_SHARED_TRACK_SEEN_H
#include "shared/bend.h"
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST float kMostSwayBend =
    0.97f; // of wind and track together: bend_intensity nears 1 and never comes there
SHARED_CONST float kLyingBend = 0.93f;  // of stems that lie
SHARED_CONST float kLyingLoss = 0.6f;   // of their height, beside the bend
SHARED_CONST float kLyingSheen = 0.45f; // paler along the pass, darker against it
SHARED_CONST float kLyingPale = 0.2f;   // from every side
SHARED_CONST float kDelay_s = 0.12f;    // C3's greatest gamma, of a blade's tip

// C3: where to look for the bend that a part of the stem has, from its root (m). It bends as the
// root did gamma ago; what runs along omega was gamma c farther on then. `share`: of the stem, 0
// root .. 1 tip. On the way back up, where theta and omega are opposed, the delay is half.
SHARED_FN vec2 track_delay(vec2 theta, vec2 omega, float share, vec2 wave_ms_gain_m) {
    float rate = length(omega);
    if (rate < 1e-2f) {
        return vec2(0.0f, 0.0f);
    }
    float gamma =
        share * min(kDelay_s, 0.5f * kPi / rate) * (dot(theta, omega) < 0.0f ? 0.5f : 1.0f);
    return omega * (gamma * (wave_ms_gain_m.x + wave_ms_gain_m.y * rate) / rate);
}

// `pressed` of a cell in a word: 16 bits each way, in steps of 1 / 16383.5 up to 2 (it is counted
// in units that may be less than 1).
SHARED_CONST float kPressedSteps = 16383.5f;
SHARED_FN int track_low(uint word) {
    return int(word << 16u) >> 16;
}
SHARED_FN int track_high(uint word) {
    return int(word) >> 16;
}
SHARED_FN uint track_word(int x, int z) {
    return (uint(x) & 0xffffu) | (uint(z) << 16u);
}
SHARED_FN vec2 track_unpack(uint word) {
    return vec2(float(track_low(word)), float(track_high(word))) * (1.0f / kPressedSteps);
}
SHARED_FN uint track_pack(vec2 pressed) {
    vec2 steps = floor(clamp(pressed, vec2(-2.0f, -2.0f), vec2(2.0f, 2.0f)) * kPressedSteps +
                       vec2(0.5f, 0.5f));
    return track_word(int(steps.x), int(steps.y));
}

// The same in the units of the next epoch, half of the time until 1/e later: exp(-1/2), in whole
// numbers, so that it is the same wherever a page lies meanwhile; toward 0, so that nothing stays
// for ever.
SHARED_CONST float kTrackEpochs = 2.0f;
SHARED_FN int track_less(int steps) {
    return steps < 0 ? -((-steps * 39750) >> 16) : (steps * 39750) >> 16;
}
SHARED_FN uint track_rebased(uint word) {
    return track_word(track_less(track_low(word)), track_less(track_high(word)));
}

// What a place, or a footprint of many cells, shows. Sums of vectors that lie against each other
// vanish: the share that lies is kept beside their mean, and of their directions the axis too.
struct TrackSeen {
    vec2 theta;
    vec2 pressed; // mean
    vec2 axis;    // mean of length times (cos, sin) of twice the direction
    float lying;  // mean length
};

SHARED_FN TrackSeen track_nothing() {
    TrackSeen seen;
    seen.theta = vec2(0.0f, 0.0f);
    seen.pressed = vec2(0.0f, 0.0f);
    seen.axis = vec2(0.0f, 0.0f);
    seen.lying = 0.0f;
    return seen;
}

SHARED_FN TrackSeen track_seen(vec2 theta, vec2 pressed) {
    TrackSeen seen;
    seen.theta = theta;
    seen.pressed = pressed;
    seen.lying = length(pressed);
    seen.axis = vec2(pressed.x * pressed.x - pressed.y * pressed.y, 2.0f * pressed.x * pressed.y) /
                max(seen.lying, 1e-6f);
    return seen;
}

SHARED_FN TrackSeen track_mean(TrackSeen a, TrackSeen b, float part) {
    TrackSeen seen;
    seen.theta = mix(a.theta, b.theta, part);
    seen.pressed = mix(a.pressed, b.pressed, part);
    seen.axis = mix(a.axis, b.axis, part);
    seen.lying = mix(a.lying, b.lying, part);
    return seen;
}

// A coarser level's texel: theta and axis in 8 bits each way; pressed in 11, its length in 10.
SHARED_FN uint track_bits(float value, float steps, uint mask) {
    return uint(int(floor(clamp(value, -1.0f, 1.0f) * steps + 0.5f))) & mask;
}
SHARED_FN float track_value(uint word, int first, int bits, float steps) {
    return float(int(word << uint(32 - first - bits)) >> (32 - bits)) / steps;
}
SHARED_FN uvec2 track_pack_seen(TrackSeen seen) {
    uint moves = track_bits(seen.theta.x, 127.0f, 255u) |
                 (track_bits(seen.theta.y, 127.0f, 255u) << 8u) |
                 (track_bits(0.5f * seen.axis.x, 127.0f, 255u) << 16u) |
                 (track_bits(0.5f * seen.axis.y, 127.0f, 255u) << 24u);
    uint lies = track_bits(0.5f * seen.pressed.x, 1023.0f, 2047u) |
                (track_bits(0.5f * seen.pressed.y, 1023.0f, 2047u) << 11u) |
                (track_bits(0.5f * seen.lying, 1023.0f, 1023u) << 22u);
    return uvec2(moves, lies);
}
SHARED_FN TrackSeen track_unpack_seen(uvec2 words) {
    TrackSeen seen;
    seen.theta = vec2(track_value(words.x, 0, 8, 127.0f), track_value(words.x, 8, 8, 127.0f));
    seen.axis =
        2.0f * vec2(track_value(words.x, 16, 8, 127.0f), track_value(words.x, 24, 8, 127.0f));
    seen.pressed =
        2.0f * vec2(track_value(words.y, 0, 11, 1023.0f), track_value(words.y, 11, 11, 1023.0f));
    seen.lying = 2.0f * float(words.y >> 22u) / 1023.0f;
    return seen;
}

// Wind (m/s) that bends by an intensity: bend_intensity's inverse.
SHARED_FN float bend_speed(float intensity, float response) {
    float left = 1.0f - clamp(intensity, 0.0f, kMostSwayBend);
    return sqrt(max(pow(left, -1.5f) - 1.0f, 0.0f)) / response;
}

// Wind and track as one: the wind that would bend the grass so. The bends add; grass that lies is
// out of the wind.
SHARED_FN vec2 sway_wind(vec2 wind, float response, vec2 theta, vec2 pressed) {
    float lying = min(length(pressed), 1.0f);
    float bent = length(theta);
    if (lying + bent < 1e-3f || response <= 0.0f) {
        return wind;
    }
    float speed = length(wind);
    vec2 blown =
        speed > 1e-4f ? wind * (bend_intensity(speed, response) / speed) : vec2(0.0f, 0.0f);
    vec2 sum = blown * (1.0f - 0.85f * lying) + theta * (1.0f - 0.5f * lying) +
               pressed * (kLyingBend * min(1.0f, 1.0f / max(length(pressed), 1e-6f)));
    float all = length(sum);
    if (all < 1e-5f) {
        return vec2(0.0f, 0.0f);
    }
    return sum * (bend_speed(all, response) / all);
}

// `pressed` of a single blade, which lies one way, among stems that lie so.
SHARED_FN vec2 sway_pressed(TrackSeen seen) {
    float mean = length(seen.pressed);
    return mean > 1e-5f ? seen.pressed * (seen.lying / mean) : vec2(seen.lying, 0.0f);
}

// A footprint's stems by the ways that they lie: four directions (x, y: unit) with weights (z)
// whose sum is 1, which have its mean, its axis and its length.
SHARED_CONST int kSwayWays = 4;
SHARED_FN vec3 sway_way(TrackSeen seen, int n) {
    float lying = max(seen.lying, 1e-6f);
    float even = min(length(seen.axis) / lying, 1.0f);
    float angle = even > 1e-4f ? 0.5f * atan(seen.axis.y, seen.axis.x) : 0.0f;
    vec2 way = vec2(cos(angle), sin(angle));
    way = n < 2 ? way : vec2(-way.y, way.x);
    float weight = 0.5f + (n < 2 ? 0.5f : -0.5f) * even;
    float one_way = clamp(dot(seen.pressed, way) / lying, -weight, weight);
    bool back = n == 1 || n == 3;
    return vec3(back ? -way.x : way.x, back ? -way.y : way.y,
                0.5f * (back ? weight - one_way : weight + one_way));
}

// Do its stems lie one way, near enough, as a single cell's do?
SHARED_FN bool sway_is_even(TrackSeen seen) {
    return seen.lying < 0.02f || length(seen.pressed) > 0.97f * seen.lying;
}

// The mean of what bends a footprint's grass.
struct SwayMean {
    vec2 wind;     // that would bend as much, along the mean of the ways
    float aligned; // length of that mean: 1 all one way, 0 as much each way as against it
};

SHARED_FN SwayMean sway_mean(vec2 wind, float response, TrackSeen seen) {
    SwayMean mean;
    mean.aligned = 1.0f;
    if (sway_is_even(seen)) {
        mean.wind = sway_wind(wind, response, seen.theta, sway_pressed(seen));
        return mean;
    }
    vec2 ways = vec2(0.0f, 0.0f);
    float intensity = 0.0f;
    for (int n = 0; n < kSwayWays; ++n) {
        vec3 way = sway_way(seen, n);
        vec2 here = sway_wind(wind, response, seen.theta, vec2(way.x, way.y) * seen.lying);
        float speed = length(here);
        ways = ways + here * (way.z / max(speed, 1e-4f));
        intensity += way.z * bend_intensity(speed, response);
    }
    mean.aligned = length(ways);
    mean.wind = ways * (bend_speed(intensity, response) / max(mean.aligned, 1e-4f));
    return mean;
}

// Factor on every height where stems lie: bent as far as B3 goes a canopy still keeps two thirds of
// its height.
SHARED_FN float lying_height(float lying) {
    return 1.0f - kLyingLoss * min(lying, 1.0f);
}

// Light that comes back from grass that lies: it shows its stems, which are paler than its tips;
// those that lie away from the eye show their whole length, paler still; toward it their ends and
// the gaps behind them, darker. Linear, so that of a footprint's means it is the mean.
SHARED_FN float lying_light(vec2 pressed, float lying, vec3 to_eye) {
    float held = min(1.0f, 1.0f / max(lying, 1e-6f));
    return 1.0f +
           held * (kLyingPale * lying - kLyingSheen * dot(pressed, vec2(to_eye.x, to_eye.z)));
}

SHARED_END
#endif
