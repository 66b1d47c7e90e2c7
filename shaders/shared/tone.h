// SPDX-License-Identifier: Apache-2.0
// Linear radiance to display.
#ifndef SWARD_SHARED_TONE_H
#define SWARD_SHARED_TONE_H
#include "shared/types.h"

SHARED_BEGIN

// Extended Reinhard on luminance (Reinhard et al. 2002, eq. 4): keeps hue, white at kWhite.
SHARED_FN vec3 tone_map(vec3 radiance) {
    float white = 4.0f;
    float l = max(dot(radiance, vec3(0.2126f, 0.7152f, 0.0722f)), 1e-6f);
    float scale = (1.0f + l / (white * white)) / (1.0f + l);
    return min(max(radiance * scale, vec3(0.0f, 0.0f, 0.0f)), vec3(1.0f, 1.0f, 1.0f));
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
