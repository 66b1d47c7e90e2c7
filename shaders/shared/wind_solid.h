// SPDX-License-Identifier: Apache-2.0
// Obstacles in the wind's window. Boxes and circles are tested in closed form; a mesh is its
// footprint, drawn once into bits of its own frame, so that standing, moving and turning cost the
// same.
#ifndef SWARD_SHARED_WIND_SOLID_H
#define SWARD_SHARED_WIND_SOLID_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kSolidBox = 0;
SHARED_CONST int kSolidCircle = 1;
SHARED_CONST int kSolidFootprint = 2;

// 64 bytes. Yaw as everywhere: 0 looks north (-z), positive to the east.
struct WindSolid {
    vec2 place;       // x, z of its origin from the window's north-west corner (m)
    vec2 heading;     // cosine, sine of its yaw
    vec2 velocity;    // x, z (m/s)
    vec2 half_size;   // of a box: half width, half depth; of a circle: its radius, twice (m)
    vec2 corner;      // of a footprint: x, z in its own frame (m)
    ivec2 bits;       // of a footprint: across (x), down (z)
    float bit_m;      // side of a bit
    int first_word;   // of a footprint
    float turn_rad_s; // clockwise from above
    int kind;         // kSolid*
};
#ifdef __cplusplus
static_assert(sizeof(WindSolid) == 64);
#endif

// A place in the solid's own frame: x to its right, z behind it.
SHARED_FN vec2 solid_frame(WindSolid solid, vec2 xz) {
    vec2 from = xz - solid.place;
    return vec2(solid.heading.x * from.x + solid.heading.y * from.y,
                solid.heading.x * from.y - solid.heading.y * from.x);
}

// Whether a box or circle covers a place of its own frame.
SHARED_FN bool solid_covers(WindSolid solid, vec2 own) {
    if (solid.kind == kSolidCircle)
        return dot(own, own) <= solid.half_size.x * solid.half_size.x;
    return abs(own.x) <= solid.half_size.x && abs(own.y) <= solid.half_size.y;
}

// Number of the bit that holds a place of a footprint's own frame, -1 outside. Rows lie one after
// the other, 32 bits a word.
SHARED_FN int solid_bit(WindSolid solid, vec2 own) {
    vec2 at = (own - solid.corner) / solid.bit_m;
    if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < float(solid.bits.x) && at.y < float(solid.bits.y)))
        return -1;
    return int(at.y) * solid.bits.x + int(at.x);
}

// Velocity of the solid's matter at a place: it moves and turns.
SHARED_FN vec2 solid_velocity(WindSolid solid, vec2 xz) {
    vec2 from = xz - solid.place;
    return solid.velocity + solid.turn_rad_s * vec2(-from.y, from.x);
}

SHARED_END
#endif
