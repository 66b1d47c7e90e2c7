// SPDX-License-Identifier: Apache-2.0
// Solid cells and how open the faces of a cell are.
#include "wind/grid.glsl"

layout(std430, binding = BIND_WIND_SOLID) readonly buffer WindSolid {
    uint wind_solid[];
};
layout(std430, binding = BIND_WIND_SOLID_VELOCITY) readonly buffer WindSolidVelocity {
    vec2 wind_solid_velocity[];
};

// Velocity of the solid at the face between two cells (element numbers): of the one that is solid,
// else of the second.
vec2 solid_velocity_between(int first, int second) {
    vec2 velocity = wind_solid_velocity[wind_solid[second] != 0u ? second : first];
    return vec2(sane(velocity.x), sane(velocity.y));
}
