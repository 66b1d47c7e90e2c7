// SPDX-License-Identifier: Apache-2.0
// In: a mesh, placed. Out: its surface, anchor-relative.
#include "lib/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
uniform vec4 place; // of its origin, world; w: scale
uniform vec4 turn;  // yaw: cosine, sine; density of the grass on it; unused

out vec3 world;
out vec3 normal;

// Yaw 0 looks north (-z), positive to the east: clockwise from above.
vec3 turned(vec3 v) {
    return vec3(turn.x * v.x - turn.y * v.z, v.y, turn.y * v.x + turn.x * v.z);
}

void main() {
    world = place.xyz + place.w * turned(position);
    normal = turned(normal_in);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
