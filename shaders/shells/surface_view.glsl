// SPDX-License-Identifier: Apache-2.0
// A ray's entry into the canopy of a mesh (B1: the surface lifted along its normals). The march
// runs in the surface's own axes there: x, z along it as its chart lays the patch, y its normal;
// height over it is a parabola by its curvature. So the march, its textures and the light are those
// of level ground, turned.
layout(binding = TEX_SECOND_DEPTH) uniform sampler2D second_depth;
layout(binding = TEX_SECOND_GROUND) uniform sampler2D second_ground;
layout(binding = TEX_SECOND_AIR) uniform sampler2D second_air;
layout(binding = TEX_CANOPY_EXIT) uniform sampler2D
    canopy_exits;               // way to the end (m), height there: of the first, of the second
uniform vec4 surface_origin;    // of the mesh's space, world
const float kLowestSun = -0.2;  // sine of its height over the surface, of the first factors
const float kOverGround = 0.99; // so much of the steepest way: what a ray passes it passes

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

// `ground`: normal, chart and density (a fraction of 0.96), room; `air`: wind along the surface,
// curvature, height over it.
Entry surface_entry(View view, float distance_m, vec4 ground, vec4 air) {
    Entry entry;
    entry.distance = distance_m;
    entry.height = air.w;
    int chart = int(ground.z);
    float fanned_out = min(fract(ground.z) / 0.96, 1.0);
    entry.frame = surface_frame(chart, octahedral(ground.xy));
    vec3 under = frame.eye + view.way * min(distance_m, kFarthest) - surface_origin.xyz -
                 entry.frame.up * (entry.height * ground.w);
    entry.place = chart_place(chart, under);
    entry.ground =
        vec4(0.0, max(ground.w, 0.05), frame.density_scale * fanned_out, surface_tint(under));
    entry.air = vec4(air.xy, 1.0, 1.0);
    entry.bend = air.z;
    entry.way_out = vec2(0.0);
    return entry;
}

Entry entry_of(View view, ivec2 pixel) {
    float distance_m = along_ray(view, texelFetch(canopy_depth, pixel, 0).r);
    Entry entry = surface_entry(view, distance_m, texelFetch(canopy_ground, pixel, 0),
                                texelFetch(canopy_air, pixel, 0));
    entry.way_out = texelFetch(canopy_exits, pixel, 0).xy;
    return entry;
}

// The next part of the canopy behind an entry: there are two.
Entry entry_behind(View view, ivec2 pixel, Entry before) {
    float distance_m = along_ray(view, texelFetch(second_depth, pixel, 0).r);
    distance_m = distance_m > before.distance ? distance_m : kNever;
    Entry entry = surface_entry(view, distance_m, texelFetch(second_ground, pixel, 0),
                                texelFetch(second_air, pixel, 0));
    entry.way_out = texelFetch(canopy_exits, pixel, 0).zw;
    entry.bend = 0.0; // in its place was how far the first part goes on behind this entry
    return entry;
}

// Height over the surface is a parabola: as high as the entry, as steep as the surface there has
// it, as high as the way out is. So a ray misses or meets the ground as it does the mesh, whatever
// facets that has. Where no way out is known: that of its curvature.
vec3 height_along(Entry entry, float fall) {
    float height = entry.height;
    float way = entry.way_out.x;
    if (way <= 0.0) {
        return vec3(height, fall, entry.bend / entry.ground.y);
    }
    float end = entry.way_out.y;
    float steepest = -2.0 * kOverGround * sqrt(height) * (sqrt(height) + sqrt(end)) /
                     way; // a steeper one would be on the ground before
    if (end > 0.0) {      // as near to the surface as the circle that the ray cuts at such an angle
        float turn = fall * entry.ground.y;
        fall *= 2.0 / (1.0 + sqrt(max(1.0 - turn * turn, 0.0)));
    }
    float slope = max(fall, steepest);
    return vec3(height, slope, ((end - height) / way - slope) / way);
}

MarchPath path_of(View view, Entry entry) {
    MarchPath path;
    float canopy = frame.canopy_m;
    float speed = length(entry.air.xy);
    float bend = 0.5 * kPi * bend_intensity(speed, frame.wind.response) / canopy;
    path.bend = vec4(entry.air.xy / max(speed, 1e-4), bend, 0.0);
    path.bend.w = march_bent_height(path, canopy);
    path.way = to_surface(entry.frame, view.way);
    path.way.y /= entry.ground.y; // over a hollow the whole canopy stands in less room
    path.from = vec3(entry.place.x, min(entry.height, path.bend.w), entry.place.y);
    float reach = entry.way_out.x > 0.0 ? entry.way_out.x : 40.0 * canopy + 0.02 * entry.distance;
    path.height = vec4(height_along(entry, path.way.y), reach);
    return path;
}

// Is there another part of the canopy behind?
bool at_crest(MarchPath path) {
    return texelFetch(second_depth, ivec2(gl_FragCoord.xy), 0).r > 0.0;
}

float ground_reach(MarchPath path) {
    float square = path.height.y * path.height.y - 4.0 * path.height.z * path.height.x;
    return square >= 0.0 && path.height.y < 0.0
               ? 2.0 * path.height.x / (-path.height.y + sqrt(square))
               : kNever;
}

// Of a hill alone.
bool is_crest_mean(MarchPath path) {
    return false;
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

// Of a mesh the factors on the light know the sun's height over the surface, too
// (shells/march_light.h).
vec3 surface_light_factors(sampler2DArray factors, vec2 uv, float sun) {
    float suns = float(textureSize(factors, 0).z);
    float place = clamp((sun - kLowestSun) / (1.0 - kLowestSun), 0.0, 1.0) * (suns - 1.0);
    float lower = min(floor(place), suns - 2.0);
    return mix(textureLod(factors, vec3(uv, lower), 0.0).rgb,
               textureLod(factors, vec3(uv, lower + 1.0), 0.0).rgb, place - lower);
}
