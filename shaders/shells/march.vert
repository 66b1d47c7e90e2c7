// SPDX-License-Identifier: Apache-2.0
// Out: a triangle over the whole screen, at a depth: that of one kind's pixels; and what the eye
// stands in.
#define LAND_SMOOTH
#include "lib/ground.glsl"
#include "lib/sway.glsl"

uniform float eye_height; // over the ground (m)
uniform float plane;
out vec2 ndc;
flat out vec2 eye_place;
flat out vec4 eye_ground;
flat out vec4 eye_air;

void main() {
#ifdef SURFACE // an eye within the canopy of a mesh is not known of
    ndc = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(ndc, plane, 1.0);
    eye_place = vec2(0.0);
    eye_ground = vec4(0.0);
    eye_air = vec4(0.0);
#else
    ndc = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(ndc, plane, 1.0);
    float canopy = frame.canopy_m;
    vec2 wind = wind_at(frame.eye.xz);
    float top = highest() * (canopy + bend_offset(canopy, canopy, wind, frame.wind.response).y);
    Ground ground = ground_surface(frame.eye.xz);
    eye_place = vec2(eye_height < top + frame.near_m ? 1.0 : 0.0, eye_height);
    eye_ground = vec4(-ground.normal.xz / max(ground.normal.y, 0.1), ground.density, ground.tint);
    eye_air = vec4(wind, sway_at(frame.eye - vec3(0.0, eye_height, 0.0), wind).xy);
#endif
}
