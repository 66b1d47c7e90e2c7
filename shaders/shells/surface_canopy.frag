// SPDX-License-Identifier: Apache-2.0
// In: a mesh's canopy. Out: what a ray that enters it there has to know of the surface and the air
// (surface_view.glsl reads it). With `behind` above 0 only what lies so far (m) behind the first
// canopy. Below 0: where a ray that has entered comes to the ground or out again; below -1: of
// those that entered there.
#include "lib/frame.glsl"
#include "shared/surface_chart.h"

layout(binding = TEX_CANOPY_DEPTH) uniform sampler2D
    canopy_depth; // of the first canopy; for ways out, of the entries
layout(binding = TEX_CANOPY_EXIT) uniform sampler2D canopy_exits;
layout(binding = TEX_SECOND_AIR) uniform sampler2D second_air;
layout(location = 0) out vec4
    out_ground; // of a way out: its length from the entry (m), height over the ground; twice
layout(location = 1) out vec4 out_air;
uniform float behind;

const float kHalfStep = 1.001;  // a half float may be so much less
const float kDepthStep = 2e-5;  // what depths of one surface may differ by, over the distance
const float kMeanHeight = 0.25; // of blade area, over the canopy

in vec3 world;
in vec3 normal;
in vec3 squares;
in vec3 products;
in vec3 wind;
in float height;
in float room;
in float on_top;
flat in int chart;

// Octahedral map of a unit vector (Cigolle et al. 2014).
vec2 flattened(vec3 v) {
    vec2 e = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    return v.z >= 0.0 ? e
                      : (1.0 - abs(e.yx)) * vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
}

// z of the parabola of the ray's height: that of a circle of the surface's curvature under the ray,
// lifted to the entry, which comes as near to the surface as the parabola then does.
float parabola(vec3 way, vec3 up) {
    vec3 along = way - up * dot(way, up);
    vec3 bent = vec3(squares.x * along.x + products.z * along.y + products.y * along.z,
                     products.z * along.x + squares.y * along.y + products.x * along.z,
                     products.y * along.x + products.x * along.y + squares.z * along.z);
    float level = dot(along, along);
    float curve = dot(along, bent) / max(level, 1e-6);
    float lifted = curve / max(1.0 + curve * height, 0.3);
    return 0.25 * clamp(lifted * frame.canopy_m, -0.5, 2.0) / frame.canopy_m *
           (1.0 + sqrt(min(level, 1.0)));
}

// Share of the set's density at the mean height of its blades' area: on a ridge blades fan out.
// Below 1: it is the fraction beside the chart.
float fanned_out() {
    float y = kMeanHeight * frame.canopy_m;
    float sum = squares.x + squares.y + squares.z;
    float product = squares.x * squares.y + squares.y * squares.z + squares.z * squares.x -
                    dot(products, products);
    return clamp(1.0 / max(1.0 + y * (sum + y * product), 1.0), 0.05, 1.0);
}

// Metres along the ray from what a depth buffer holds.
float beyond(float depth) {
    vec3 ray = world - frame.eye;
    float far = length(ray);
    float axis = (frame.clip_from_world * vec4(world, 1.0)).w / far;
    return depth > 0.0 ? far - frame.near_m / (depth * axis) : 0.0;
}

// What lies before the entry, or before the first part's end, is another part's; a fold's inside is
// no way out.
void way_out() {
    float way = beyond(texelFetch(canopy_depth, ivec2(gl_FragCoord.xy), 0).r);
    float least = behind < -1.0 ? texelFetch(second_air, ivec2(gl_FragCoord.xy), 0).z : 0.0;
    vec3 ray = world - frame.eye;
    if (way <= kDepthStep * length(ray) + kHalfStep * least ||
        (on_top > 0.5 && height > 0.0 && dot(ray, normal) < 0.0)) {
        discard;
    }
    out_ground = vec4(way, height, way, height);
    out_air = vec4(0.0);
}

void main() {
    if (behind < 0.0) {
        way_out();
        return;
    }
    bool top = on_top > 0.5;
    // Where the surface is hollow, the lifted one may be folded: of what then shows from within the
    // true top lies elsewhere.
    if (top && dot(world - frame.eye, normal) > 0.0) {
        discard;
    }
    if (behind > 0.0) {
        float depth = texelFetch(canopy_depth, ivec2(gl_FragCoord.xy), 0).r;
        vec4 clip = frame.clip_from_world * vec4(world, 1.0);
        if (depth <= 0.0 || clip.w < frame.near_m / depth * (1.0 + kDepthStep) + behind) {
            discard;
        }
    }
    vec3 up = normalize(normal);
    SurfaceFrame axes = surface_frame(chart, up);
    vec3 local = to_surface(axes, wind);
    out_ground = vec4(flattened(up), float(chart) + 0.96 * fanned_out(), room);
    float first_goes_on = kHalfStep * texelFetch(canopy_exits, ivec2(gl_FragCoord.xy), 0).x -
                          beyond(texelFetch(canopy_depth, ivec2(gl_FragCoord.xy), 0).r);
    out_air =
        vec4(local.x, local.z,
             behind > 0.0 ? max(first_goes_on, 0.0) : parabola(normalize(world - frame.eye), up),
             height);
}
