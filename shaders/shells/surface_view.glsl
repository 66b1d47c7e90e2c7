// SPDX-License-Identifier: Apache-2.0
// A ray's entry into the canopy of a mesh (B1: the surface lifted along its normals). The march runs in the surface's own axes there:
// x, z along it as its chart lays the patch, y its normal; height over it is a parabola by its curvature. So the march, its textures and
// the light are those of level ground, turned.
layout(binding = TEX_SECOND_DEPTH) uniform sampler2D second_depth;
layout(binding = TEX_SECOND_GROUND) uniform sampler2D second_ground;
layout(binding = TEX_SECOND_AIR) uniform sampler2D second_air;
layout(binding = TEX_CANOPY_EXIT) uniform sampler2D canopy_exit;
uniform vec4 surface_origin; // of the mesh's space, world

float along_ray(View view, float depth) {
    return depth > 0.0 ? frame.near_m / (depth * view.axis) : kNever;
}

// Inverse of the octahedral map (Cigolle et al. 2014).
vec3 octahedral(vec2 e) {
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (v.z < 0.0) {
        v.xy = (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
    }
    return normalize(v);
}

// `ground`: normal, chart and density (a fraction of 0.96), room; `air`: wind along the surface, curvature, height over it.
Entry surface_entry(View view, float distance_m, vec4 ground, vec4 air) {
    Entry entry;
    entry.distance = distance_m;
    entry.height = air.w;
    int chart = int(ground.z);
    float fanned_out = min(fract(ground.z) / 0.96, 1.0);
    entry.frame = surface_frame(chart, octahedral(ground.xy));
    vec3 under = frame.eye.xyz + view.way * min(distance_m, kFarthest) - surface_origin.xyz - entry.frame.up * (entry.height * ground.w);
    entry.place = chart_place(chart, under);
    entry.ground = vec4(0.0, max(ground.w, 0.05), frame.grass.y * fanned_out, surface_tint(under));
    entry.air = vec4(air.xy, 1.0, 1.0);
    entry.curve_end = vec2(air.z, kNever);
    return entry;
}

Entry entry_of(View view, ivec2 pixel) {
    float distance_m = along_ray(view, texelFetch(canopy_depth, pixel, 0).r);
    Entry entry = surface_entry(view, distance_m, texelFetch(canopy_ground, pixel, 0), texelFetch(canopy_air, pixel, 0));
    float end = along_ray(view, texelFetch(canopy_exit, pixel, 0).r);
    entry.curve_end.y = end > distance_m ? end : kNever;
    return entry;
}

// Another part of the canopy behind the first.
Entry second_entry(View view, ivec2 pixel) {
    float distance_m = along_ray(view, texelFetch(second_depth, pixel, 0).r);
    return surface_entry(view, distance_m, texelFetch(second_ground, pixel, 0), texelFetch(second_air, pixel, 0));
}

MarchPath path_of(View view, Entry entry) {
    MarchPath path;
    float canopy = frame.patch_grid.w;
    float speed = length(entry.air.xy);
    float bend = 0.5 * kPi * bend_intensity(speed, frame.wind.mean.w) / canopy;
    path.bend = vec4(entry.air.xy / max(speed, 1e-4), bend, 0.0);
    path.bend.w = march_bent_height(path, canopy);
    path.way = to_surface(entry.frame, view.way);
    path.way.y /= entry.ground.y; // over a hollow the whole canopy stands in less room
    path.from = vec3(entry.place.x, min(entry.height, path.bend.w), entry.place.y);
    float reach = min(40.0 * canopy + 0.02 * entry.distance, entry.curve_end.y - entry.distance);
    path.height = vec4(path.from.y, path.way.y, entry.curve_end.x / entry.ground.y, reach);
    return path;
}

// Is there another part of the canopy behind?
bool at_crest(MarchPath path) {
    return texelFetch(second_depth, ivec2(gl_FragCoord.xy), 0).r > 0.0;
}

float ground_reach(MarchPath path) {
    float square = path.height.y * path.height.y - 4.0 * path.height.z * path.height.x;
    return square >= 0.0 && path.height.y < 0.0 ? 2.0 * path.height.x / (-path.height.y + sqrt(square)) : kNever;
}

Light light_at(Entry entry) {
    Light light = light_under(frame.light, 0.5 + 0.5 * entry.frame.up.y);
    light.to_sun.xyz = to_surface(entry.frame, light.to_sun.xyz);
    return light;
}
vec3 normal_at(Entry entry) {
    return entry.frame.up;
}
vec3 to_eye_at(Entry entry, View view) {
    return -to_surface(entry.frame, view.way);
}
float rise_at(Entry entry, View view) {
    return 0.0;
}
