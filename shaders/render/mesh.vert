// SPDX-License-Identifier: Apache-2.0
// In: a mesh, placed. Out: its surface, anchor-relative.
#include "lib/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
uniform vec4 place;                  // of its origin, world; w: scale
uniform vec4 axis_x, axis_y, axis_z; // its own axes in the world's; w: unused

out vec3 world;
out vec3 normal;

vec3 turned(vec3 v) {
    return v.x * axis_x.xyz + v.y * axis_y.xyz + v.z * axis_z.xyz;
}

void main() {
    world = place.xyz + place.w * turned(position);
    normal = turned(normal_in);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
