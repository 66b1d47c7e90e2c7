// SPDX-License-Identifier: Apache-2.0
// What a step of the tracks is told: rules, prints, blocks (C1 to C4).
#ifndef SWARD_SHARED_TRACK_PRINT_H
#define SWARD_SHARED_TRACK_PRINT_H
#include "shared/types.h"

SHARED_BEGIN

// What all cells share in a step. 48 bytes.
struct TrackRules {
    float cell_m;
    float step_s;
    float damping;         // l of C2
    float recovery_per_s2; // restoring term k
    float wave_mps;        // c0
    float rate_wave_mps;   // c_omega
    float wave_gain_m;     // mu
    float most_wave_mps;   // greatest speed of a wave, inside the stable bound
    float canopy_m;
    float broken; // share of stems that break under a full load
    float left;   // of a pressed cell's 1 since its count began
    float unused; // to 48 bytes
};

// Where a print is. 16 bytes.
struct TrackPlace {
    vec2 place;   // x, z (m)
    vec2 heading; // cosine, sine of its yaw
};

// Relative to a page's north-west corner (m). 64 bytes.
struct TrackPrint {
    TrackPlace now;    // at the step's end
    TrackPlace before; // at its start
    float half_width_m;
    float half_depth_m;               // or radius
    float underside_m;                // its lowest height over the ground
    float load;                       // share of its load, 0..1
    int kind;                         // kPrint*
    int unused_a, unused_b, unused_c; // to 64 bytes
};
SHARED_CONST int kPrintBox = 0;    // its underside is flat
SHARED_CONST int kPrintSphere = 1; // half_depth_m: radius
SHARED_CONST int kPrintWheel =
    2; // rolls along its own z; half_width_m: half of its width, half_depth_m: radius

// A block that is stepped, or only pressed. 48 bytes.
struct TrackBlock {
    int slot; // of its page
    int first_print;
    int prints;
    int own;          // its place in the pool of what moves
    ivec4 beside;     // places there of those to the west, east, north, south; -1: at rest
    ivec2 first_cell; // x, z in the page
    vec2 slope;       // of the ground: dy/dx, dy/dz
};
#ifdef __cplusplus
static_assert(sizeof(TrackRules) == 48 && sizeof(TrackPrint) == 64 && sizeof(TrackBlock) == 48);
#endif

SHARED_END
#endif
