// SPDX-License-Identifier: Apache-2.0
// The only way any shader learns of wind. Anchor-relative xz in, velocity (m/s; x east, z south)
// out.
#include "lib/frame.glsl"
#include "lib/wind_field.glsl"

vec2 wind_at(vec2 xz) {
    return wind_of(frame.wind, xz);
}
