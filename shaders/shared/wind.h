// SPDX-License-Identifier: Apache-2.0
// The mean wind with travelling gusts that wind_at() answers from. The fluid will take its place; the interface stays.
#ifndef SWARD_SHARED_WIND_H
#define SWARD_SHARED_WIND_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kGustWaves = 6;

// Phases hold the time and the anchor's place already (reduced in double precision on the CPU), so that a shader only adds
// k . xz for points near the anchor. 112 bytes.
struct WindField {
    vec4 mean;     // mean velocity x, z (m/s); gust 0..1; response of the grass, 1 / (m/s)
    vec4 waves[6]; // wave vector x, z (rad/m); phase (rad); amplitude, the sum of all is 1
};
#ifdef __cplusplus
static_assert(sizeof(WindField) == 112);
#endif

// Wind velocity (m/s; x east, z south) at anchor-relative xz. Speed stays within mean * [1 - 0.8 gust, 1 + 1.6 gust].
SHARED_FN vec2 wind_field_at(WindField field, vec2 xz) {
    float front = 0.0f;
    float sway = 0.0f;
    for (int i = 0; i < kGustWaves; ++i) {
        float phase = dot(vec2(field.waves[i].x, field.waves[i].y), xz) + field.waves[i].z;
        front += field.waves[i].w * sin(phase);
        sway += field.waves[i].w * cos(phase * 0.5f);
    }
    // Gusts rise fast and are rarer than lulls: square the positive side of the sum.
    float push = front > 0.0f ? front * (0.8f + 0.8f * front) : front * 0.8f;
    float speed = 1.0f + field.mean.z * push;
    float turn = 0.35f * field.mean.z * sway;
    vec2 along = vec2(field.mean.x, field.mean.y);
    vec2 across = vec2(-field.mean.y, field.mean.x);
    return speed * (along * cos(turn) + across * sin(turn));
}

SHARED_END
#endif
