// SPDX-License-Identifier: Apache-2.0
// Where the samples of the reference's jittered pictures lie, all in one picture's pixels.
#ifndef SWARD_SHARED_SAMPLE_PLACES_H
#define SWARD_SHARED_SAMPLE_PLACES_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kRoundPictures = 16; // pictures that share a choice of blades: bits of a mask
SHARED_CONST int kMostSamples = 8;    // a pixel

// 2064 bytes.
struct SampleRound {
    ivec4 counts; // pictures; samples a pixel
    vec4 places[kRoundPictures *
                kMostSamples]; // x, y of each picture's samples, of the pixel at 0, 0
};
#ifdef __cplusplus
static_assert(sizeof(SampleRound) == 16 + 16 * kRoundPictures * kMostSamples);
#endif

SHARED_END
#endif
