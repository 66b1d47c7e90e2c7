// SPDX-License-Identifier: Apache-2.0
// In: a posed blade. Out: its surface (J8): outline, fold along the middle, pixel-width correction.
// SURFACE: a blade of a mesh.
#include "lib/frame.glsl"
#include "shared/blade.h"
#ifdef SURFACE
#include "shared/surface_blade.h"
uniform vec4 surface_shape;
out float open_sky;
#endif

layout(quads, equal_spacing, ccw) in;

in BladeControl {
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

out vec3 world;
out vec3 tangent;
out vec2 sway;
out vec3 normal;
out vec2 along;     // place along the blade; rest height over the canopy's
flat out vec4 own;  // rank, seed, distance for tier selection, cosine ground to sun
flat out vec3 sort; // tint of the ground, species, share of the simulated pose
out vec3 air_added;
out vec3 air_through;

void main() {
    float u = gl_TessCoord.x;
#ifdef SURFACE
    float level = gl_TessLevelOuter[0];
    bool of_set = surface_shape.x == kShapeOfSet;
    BladeOutline outline = frame.looks[int(blade_in[0].ground.z)].outline;
    float v = of_set ? blade_station(gl_TessCoord.y, outline)
                     : surface_blade_station(gl_TessCoord.y, surface_shape, level);
    vec3 t1 = blade_in[0].across.xyz;
    open_sky = blade_in[0].sway.z;
#else
    BladeOutline outline = frame.looks[int(blade_in[0].ground.z)].outline;
    float v = blade_station(gl_TessCoord.y, outline);
    vec3 t1 = blade_width_direction(blade_in[0].v2.w);
#endif
    vec3 v1 = blade_in[0].v1.xyz;
    vec3 v2 = blade_in[0].v2.xyz;
    float half_width = blade_in[0].v1.w;
    vec3 centre = blade_in[0].root.xyz + blade_curve(v1, v2, v);
    vec3 t0 = blade_tangent(v1, v2, v);
    vec3 n = normalize(cross(t0, t1));
    float pixels = 2.0 * half_width * frame.focal_px / max(distance(centre, frame.eye), 0.05);
    float phi = 1.0 - clamp((pixels - frame.width_least_px) / frame.width_span_px, 0.0, 1.0);
#ifdef SURFACE
    float t = of_set ? mix(blade_outline(u, v, outline), u, phi * phi)
                     : surface_blade_outline(u, v, surface_shape, vec2(level, phi));
#else
    float t = mix(blade_outline(u, v, outline), u, phi * phi);
#endif
    world = centre + t1 * (half_width * (2.0 * t - 1.0));
    world += n * (half_width * (0.5 - abs(u - 0.5)) * (1.0 - v));
    tangent = t0;
    sway = blade_in[0].sway.xy;
    normal = n;
    along = vec2(v, 2.0 * v * (1.0 - v) * blade_in[0].rest.x + v * v * blade_in[0].rest.y);
    own = vec4(blade_in[0].rest.zw, blade_in[0].root.w, blade_in[0].ground.x);
    sort = blade_in[0].ground.yzw;
    AirLight air = haze_of(world - frame.eye);
    air_added = air.added;
    air_through = air.through;
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
