// SPDX-License-Identifier: Apache-2.0
// In: a posed blade. Out: the same, with as many segments as its length in pixels deserves.
#include "lib/frame.glsl"

layout(vertices = 1) out;

in BladeVertex {
    vec4 root;
    vec4 v1;
    vec4 v2;
    vec4 sway;
    vec4 rest;
    vec4 ground;
} blade_in[];

out BladeControl {
    vec4 root;
    vec4 v1;
    vec4 v2;
    vec4 sway;
    vec4 rest;
    vec4 ground;
} blade_out[];

void main() {
    blade_out[gl_InvocationID].root = blade_in[0].root;
    blade_out[gl_InvocationID].v1 = blade_in[0].v1;
    blade_out[gl_InvocationID].v2 = blade_in[0].v2;
    blade_out[gl_InvocationID].sway = blade_in[0].sway;
    blade_out[gl_InvocationID].rest = blade_in[0].rest;
    blade_out[gl_InvocationID].ground = blade_in[0].ground;

    float pixels = frame.eye.w / max(distance(blade_in[0].root.xyz, frame.eye.xyz), 0.05);
    float span = length(blade_in[0].v1.xyz) + length(blade_in[0].v2.xyz - blade_in[0].v1.xyz);
    // A head has a curved rim of its own.
    float least = frame.looks[int(blade_in[0].ground.z)].outline.z < 1.0 ? 8.0 : 2.0;
    float along = clamp(ceil(span * pixels / frame.pose_band.z), least, 12.0);
    // The fold needs a middle; below a few pixels of width nobody sees it.
    float across = 2.0 * blade_in[0].v1.w * pixels > 3.0 ? 2.0 : 1.0;
    gl_TessLevelOuter[0] = along;
    gl_TessLevelOuter[1] = across;
    gl_TessLevelOuter[2] = along;
    gl_TessLevelOuter[3] = across;
    gl_TessLevelInner[0] = across;
    gl_TessLevelInner[1] = along;
}
