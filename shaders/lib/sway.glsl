// SPDX-License-Identifier: Apache-2.0
// What bends the grass at a place, wind and track as one, and what that does to the light in it.
#include "lib/track.glsl"
#include "lib/wind.glsl"
#include "shared/bend.h"

// What every tier bends by.
struct Sway {
    vec2 wind;    // that would bend it as wind and track do (m/s)
    vec2 pressed; // stems that lie: along which way, how many of them
};

// `width`: of what the answer stands for (m).
Sway sway_at(vec2 xz, float width) {
    vec2 wind = wind_at(xz);
    if (!has_tracks()) {
        return Sway(wind, vec2(0.0));
    }
    vec4 track = track_at(xz, width);
    return Sway(sway_wind(wind, frame.wind.mean.w, track.xy, track.zw), track.zw);
}

// canopy_sway for the set's first species, sun and eye; x, z of where the bend turns an upright blade at kLeanHeight.
vec4 sway_at(vec3 ground, vec2 wind) {
    float canopy = frame.patch_grid.w;
    vec3 to_eye = normalize(frame.eye.xyz - ground - vec3(0.0, kSwayHeight * canopy, 0.0));
    vec3 turn = bend_turn(kSwayHeight * canopy, canopy, wind, frame.wind.mean.w);
    vec3 lean = bend_turn(kLeanHeight * canopy, canopy, wind, frame.wind.mean.w);
    return vec4(canopy_sway(frame.looks[0], turn, frame.light.to_sun.xyz, to_eye), lean.xz);
}

// The same with what lies there.
vec4 sway_at(vec3 ground, Sway sway) {
    vec4 light = sway_at(ground, sway.wind);
    if (has_tracks()) {
        light.x *= lying_light(sway.pressed, normalize(frame.eye.xyz - ground));
    }
    return light;
}
