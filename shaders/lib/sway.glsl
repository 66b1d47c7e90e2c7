// SPDX-License-Identifier: Apache-2.0
// What bends the grass at a place, wind and track as one, and what that does to the light in it.
#include "lib/land_shadow.glsl"
#include "lib/track.glsl"
#include "lib/wind.glsl"
#include "shared/bend.h"

// What every tier bends by.
struct Sway {
    vec2 wind;     // that would bend it as wind and track do (m/s)
    vec2 pressed;  // stems that lie: along which way, how many of them; of a footprint the mean
    float lying;   // share of stems that lie, whichever way
    float aligned; // how much of the bend's way is left in the mean over a footprint; 1 of a blade
};

// A blade's.
Sway sway_at(vec2 xz) {
    vec2 wind = wind_at(xz);
    if (!has_tracks()) {
        return Sway(wind, vec2(0.0), 0.0, 1.0);
    }
    TrackSeen track = track_at(xz, 0.0);
    vec2 pressed = sway_pressed(track);
    return Sway(sway_wind(wind, frame.wind.response, track.theta, pressed), pressed, track.lying,
                1.0);
}

// What bends its tip, whose bend comes from farther ahead (C3).
vec2 sway_tip(vec2 xz, Sway root, vec2 ahead) {
    return sway_wind(wind_at(xz), frame.wind.response, track_at(xz + ahead, 0.0).theta,
                     root.pressed);
}

// A footprint's, from the wind there.
Sway sway_of(vec2 wind, TrackSeen track) {
    SwayMean mean = sway_mean(wind, frame.wind.response, track);
    return Sway(mean.wind, track.pressed, track.lying, mean.aligned);
}

// canopy_sway for the set's first species, sun and eye, its sunlight less what the land hides; x, z
// of where the bend turns an upright blade at kLeanHeight.
vec4 sway_at(vec3 ground, vec2 wind) {
    float canopy = frame.canopy_m;
    vec3 to_eye = normalize(frame.eye - ground - vec3(0.0, kSwayHeight * canopy, 0.0));
    vec3 turn = bend_turn(kSwayHeight * canopy, canopy, wind, frame.wind.response);
    vec3 lean = bend_turn(kLeanHeight * canopy, canopy, wind, frame.wind.response);
    vec4 sway = vec4(canopy_sway(frame.looks[0], turn, frame.light.to_sun, to_eye), lean.xz);
    sway.x *= sun_seen(ground.xz, 0.0);
    return sway;
}

// The same with what lies there.
vec4 sway_at(vec3 ground, Sway sway) {
    vec4 light = sway_at(ground, sway.wind);
    if (has_tracks()) {
        light.x *= lying_light(sway.pressed, sway.lying, normalize(frame.eye - ground));
    }
    return light;
}

// And of a footprint: the mean over the ways that its stems lie.
vec4 sway_over(vec3 ground, vec2 wind, TrackSeen track) {
    vec4 light = vec4(0.0);
    if (sway_is_even(track)) {
        light =
            sway_at(ground, sway_wind(wind, frame.wind.response, track.theta, sway_pressed(track)));
    } else {
        for (int n = 0; n < kSwayWays; ++n) {
            vec3 way = sway_way(track, n);
            if (way.z > 0.01) {
                light += way.z * sway_at(ground, sway_wind(wind, frame.wind.response, track.theta,
                                                           way.xy * track.lying));
            }
        }
    }
    light.x *= lying_light(track.pressed, track.lying, normalize(frame.eye - ground));
    return light;
}
