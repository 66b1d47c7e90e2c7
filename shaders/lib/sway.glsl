// SPDX-License-Identifier: Apache-2.0
// What the wind at a place does to the light in the grass there: canopy_sway for the set's first species, sun and eye.
#include "lib/wind.glsl"
#include "shared/bend.h"

// canopy_sway; x, z of where the bend turns an upright blade at kLeanHeight.
vec4 sway_at(vec3 ground, vec2 wind) {
    float canopy = frame.patch_grid.w;
    vec3 to_eye = normalize(frame.eye.xyz - ground - vec3(0.0, kSwayHeight * canopy, 0.0));
    vec3 turn = bend_turn(kSwayHeight * canopy, canopy, wind, frame.wind.mean.w);
    vec3 lean = bend_turn(kLeanHeight * canopy, canopy, wind, frame.wind.mean.w);
    return vec4(canopy_sway(frame.looks[0], turn, frame.light.to_sun.xyz, to_eye), lean.xz);
}
