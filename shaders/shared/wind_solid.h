// SPDX-License-Identifier: Apache-2.0
// Obstacles in the wind's window. Boxes and circles are tested in closed form; a mesh is its footprint, drawn once into bits of
// its own frame, so that standing, moving and turning cost the same.
#ifndef SWARD_SHARED_WIND_SOLID_H
#define SWARD_SHARED_WIND_SOLID_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kSolidBox = 0;
SHARED_CONST int kSolidCircle = 1;
SHARED_CONST int kSolidFootprint = 2;

// 64 bytes. Yaw as everywhere: 0 looks north (-z), positive to the east.
struct WindSolid {
    vec4 place;   // x, z of its origin from the window's north-west corner (m); cos, sin of its yaw
    vec4 shape;   // box: half width, half depth; circle: radius; footprint: corner x, z in its frame (m); z: side of a bit (m)
    vec4 motion;  // velocity x, z (m/s); turn (rad/s, clockwise from above); kind
    ivec4 bitmap; // footprint: first word; bits across (x), down (z); unused
};
#ifdef __cplusplus
static_assert(sizeof(WindSolid) == 64);
#endif

// A place in the solid's own frame: x to its right, z behind it.
SHARED_FN vec2 solid_frame(WindSolid solid, vec2 xz) {
    vec2 from = xz - vec2(solid.place.x, solid.place.y);
    return vec2(solid.place.z * from.x + solid.place.w * from.y, solid.place.z * from.y - solid.place.w * from.x);
}

// Whether a box or circle covers a place of its own frame.
SHARED_FN bool solid_covers(WindSolid solid, vec2 own) {
    if (int(solid.motion.w + 0.5f) == kSolidCircle)
        return dot(own, own) <= solid.shape.x * solid.shape.x;
    return abs(own.x) <= solid.shape.x && abs(own.y) <= solid.shape.y;
}

// Number of the bit that holds a place of a footprint's own frame, -1 outside. Rows lie one after the other, 32 bits a word.
SHARED_FN int solid_bit(WindSolid solid, vec2 own) {
    vec2 at = (own - vec2(solid.shape.x, solid.shape.y)) / solid.shape.z;
    if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < float(solid.bitmap.y) && at.y < float(solid.bitmap.z)))
        return -1;
    return int(at.y) * solid.bitmap.y + int(at.x);
}

// Velocity of the solid's matter at a place: it moves and turns.
SHARED_FN vec2 solid_velocity(WindSolid solid, vec2 xz) {
    vec2 from = xz - vec2(solid.place.x, solid.place.y);
    return vec2(solid.motion.x, solid.motion.y) + solid.motion.z * vec2(-from.y, from.x);
}

SHARED_END
#endif
