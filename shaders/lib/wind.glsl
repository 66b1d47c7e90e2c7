// SPDX-License-Identifier: Apache-2.0
// The only way any shader learns of wind. World xz in, velocity (m/s; x east, z south) out.
#include "lib/frame.glsl"

vec2 wind_at(vec2 xz) {
    return wind_field_at(frame.wind, xz);
}
