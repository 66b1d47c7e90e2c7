// SPDX-License-Identifier: Apache-2.0
// In: a posed blade. Out: the same, with as many segments as its length in pixels deserves.
// SURFACE: a blade of a mesh, whose shape says where its stations have to stand.
#include "lib/frame.glsl"
#ifdef SURFACE
#include "shared/surface_blade.h"
uniform vec4 surface_shape;
#endif

layout(vertices = 1) out;

in BladeVertex {
    vec4 root;
    vec4 v1;
    vec4 v2;
    vec4 sway;
    vec4 rest;
    vec4 ground;
#ifdef SURFACE
    vec4 across;
#endif
} blade_in[];

out BladeControl {
    vec4 root;
    vec4 v1;
    vec4 v2;
    vec4 sway;
    vec4 rest;
    vec4 ground;
#ifdef SURFACE
    vec4 across;
#endif
} blade_out[];

void main() {
    blade_out[gl_InvocationID].root = blade_in[0].root;
    blade_out[gl_InvocationID].v1 = blade_in[0].v1;
    blade_out[gl_InvocationID].v2 = blade_in[0].v2;
    blade_out[gl_InvocationID].sway = blade_in[0].sway;
    blade_out[gl_InvocationID].rest = blade_in[0].rest;
    blade_out[gl_InvocationID].ground = blade_in[0].ground;

    float pixels = frame.focal_px / max(distance(blade_in[0].root.xyz, frame.eye), 0.05);
    float span = length(blade_in[0].v1.xyz) + length(blade_in[0].v2.xyz - blade_in[0].v1.xyz);
#ifdef SURFACE
    blade_out[gl_InvocationID].across = blade_in[0].across;
    // Teeth are finer than the blade's curve.
    float finer = surface_shape.x == float(kShapeDandelion) ? 3.0 : 1.0;
    float wanted = ceil(span * pixels / frame.segment_px);
    bool head = frame.looks[int(blade_in[0].ground.z)].outline.head_from < 1.0;
    float along = surface_shape.x == kShapeOfSet
                      ? clamp(wanted, head ? 8.0 : 2.0, 12.0)
                      : surface_blade_level(ceil(finer * span * pixels / frame.segment_px), 24.0,
                                            surface_shape);
#else
    // A head has a curved rim of its own.
    float least = frame.looks[int(blade_in[0].ground.z)].outline.head_from < 1.0 ? 8.0 : 2.0;
    float along = clamp(ceil(span * pixels / frame.segment_px), least, 12.0);
#endif
    // The fold needs a middle; below a few pixels of width nobody sees it.
    float across = 2.0 * blade_in[0].v1.w * pixels > 3.0 ? 2.0 : 1.0;
    gl_TessLevelOuter[0] = along;
    gl_TessLevelOuter[1] = across;
    gl_TessLevelOuter[2] = along;
    gl_TessLevelOuter[3] = across;
    gl_TessLevelInner[0] = across;
    gl_TessLevelInner[1] = along;
}
