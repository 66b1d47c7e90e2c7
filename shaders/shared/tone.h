// SPDX-License-Identifier: Apache-2.0
// Linear radiance to display.
#ifndef SWARD_SHARED_TONE_H
#define SWARD_SHARED_TONE_H
#include "shared/types.h"

SHARED_BEGIN

// Filmic curve fitted to the ACES reference transform (Narkowicz 2015), per channel: deep shade,
// bright sky, no clipping.
SHARED_FN vec3 tone_map(vec3 radiance) {
    vec3 x = max(radiance * 0.62f, vec3(0.0f, 0.0f, 0.0f));
    vec3 y = (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
    return min(y, vec3(1.0f, 1.0f, 1.0f));
}

// IEC 61966-2-1.
SHARED_FN float srgb_encode_one(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}

SHARED_FN vec3 srgb_encode(vec3 c) {
    return vec3(srgb_encode_one(c.x), srgb_encode_one(c.y), srgb_encode_one(c.z));
}

SHARED_END
#endif
