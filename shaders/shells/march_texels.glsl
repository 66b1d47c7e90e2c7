// SPDX-License-Identifier: Apache-2.0
// What the march reads of one kind's textures. For march.frag.
layout(binding = TEX_MARCH_DENSITY) uniform sampler2DArray densities;
layout(binding = TEX_MARCH_FIBRES) uniform sampler2DArray fibres;
layout(binding = TEX_MARCH_CORRECTION) uniform sampler2DArray correction;
layout(binding = TEX_MARCH_LIGHT) uniform sampler2DArray light_factors;
uniform int kind;

const float kLeastShown = 0.02;  // share of a pixel: what shows less has its layer's mean tangent
                                 // (no pixel differs by more than 3/255)
const float kOtherDensity = 0.4; // of the correction's second factors

// Factors on the optical depth and on the light.
vec2 correction_at(MarchPlan plan) {
    vec2 size = vec2(float(kMarchElevations), float(kMarchMips));
    vec2 uv = (vec2(plan.table.y, plan.table.x) + 0.5) / size;
    float thin = clamp((1.0 - plan.density) / (1.0 - kOtherDensity), 0.0, 1.3);
    vec4 factors = textureLod(correction, vec3(uv, float(kind)), 0.0);
    return max(mix(factors.xy, factors.zw, thin), vec2(0.05));
}

// What the mean light of such a view is to be multiplied by (shells/march_light.h). `elevation`:
// sine of the view's over the ground.
float light_factor(vec3 to_eye, vec3 to_sun, vec2 wind, float elevation) {
    vec2 eye = to_eye.xz + vec2(1e-5, 0.0);
    vec2 sun = to_sun.xz + vec2(1e-5, 0.0);
    float azimuth = atan(eye.x * sun.y - eye.y * sun.x, dot(eye, sun)) / (2.0 * kPi);
    vec2 size = vec2(textureSize(light_factors, 0));
    vec2 uv = vec2(azimuth + 0.5 / size.x, (elevation * (size.y - 1.0) + 0.5) / size.y);
    float gust = far_wind_place(frame.wind, wind); // 0..2: one channel for each wind
#ifdef SURFACE
    vec3 winds = surface_light_factors(light_factors, uv, to_sun.y);
#else
    vec3 winds = textureLod(light_factors, vec3(uv, 0.0), 0.0).rgb;
#endif
    return gust < 1.0 ? mix(winds.r, winds.g, gust) : mix(winds.g, winds.b, gust - 1.0);
}

// Where a step's texel is.
struct Texel {
    vec3 uv;  // in its image, number of that in the array
    uint lie; // of the patch on the tile there
};

Texel texel_of(MarchPlan plan, MarchStep taken) {
    vec2 place = (taken.rest.xz + frame.patch_offset_m) / frame.patch_side_m;
    ivec2 tile = ivec2(floor(place)) + frame.anchor_tile;
#ifdef SURFACE
    uint lie = kLieAsGrown;
#else
    uint lie = tile_lie(tile);
#endif
    plan.axis = lie_turned(lie) ? 1 - plan.axis : plan.axis;
    return Texel(
        march_texel(plan, taken,
                    vec3(lie_source(lie, place), float(tile_variant(tile, frame.patch_variants)))),
        lie);
}

// Are a step's blades seen well enough to be told apart?
bool shows_fibres(MarchStep taken, float shown) {
    return taken.mip < kFibresTo && shown > kLeastShown;
}

// Mean tangent of the blades at a step, as the wind turns them: read where they are told apart,
// else the layer's.
vec3 mean_tangent(MarchPath path, MarchStep taken, Texel at, float shown) {
    vec3 mean = vec3(0.0, medium.layers[taken.layer].x, 0.0);
    if (shows_fibres(taken, shown)) {
        vec4 texel = textureLod(fibres, at.uv, taken.mip - march_base(kind));
        vec2 level = lie_along(at.lie, 2.0 * texel.xz - 1.0);
        mean = march_fibre(taken, vec3(level.x, texel.y, level.y));
    }
    return march_turned(path, taken.rest.y, mean);
}
