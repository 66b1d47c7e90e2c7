// SPDX-License-Identifier: Apache-2.0
// The one shading function of grass: Kajiya-Kay / Banks (G4) with canopy darkening, for blades,
// shells, slices and the far appearance. Linear radiance; colours are reflectances.
#ifndef SWARD_SHARED_SHADING_H
#define SWARD_SHARED_SHADING_H
#include "shared/grass_layout.h"
#include "shared/hash.h"
#include "shared/light.h"
#include "shared/types.h"

SHARED_BEGIN

// Extinction by the whole canopy (optical depth) of sunlight at zenith and of skylight: every Light
// has these, in the renderer and in texgen's far table.
SHARED_CONST float kSunExtinction = 0.55f;
SHARED_CONST float kSkyExtinction = 1.1f;

// Colour of a blade at place v along it (0 root .. 1 tip). rank and seed make it this blade's own,
// in every tier. `detail` 1: its own; 0: the mean of all blades, for pixels that hold many of them.
// The mean over blades is the same at every detail.
SHARED_FN vec3 blade_albedo(GrassAppearance look, vec2 rank_seed, float v, float detail) {
    uint h = hash_pcg(uint(rank_seed.x * 256.0f) * 256u + uint(rank_seed.y * 256.0f));
    float hue = (float(h & 255u) / 255.0f - 0.5f) * detail;
    float value = (float((h >> 8u) & 255u) / 255.0f - 0.5f) * detail;
    float dryness = float(h >> 16u) / 65536.0f;
    // A dry blade is dry all over; of the others two in five are at the tip.
    float dry_share = look.dry_share;
    float tip = 0.5f * smoothstep(0.75f, 1.0f, v);
    float own_dry = dryness < dry_share                          ? 0.85f
                    : dryness > 1.0f - 0.4f * (1.0f - dry_share) ? tip
                                                                 : 0.0f;
    float mean_dry = 0.85f * dry_share + 0.4f * (1.0f - dry_share) * tip;
    vec3 colour = mix(look.root, look.tip, v) *
                  (1.0f + look.variation * (0.7f * value + hue * vec3(1.0f, 0.05f, -0.3f)));
    colour = mix(colour, look.dry * (1.0f + 0.4f * value), mix(mean_dry, own_dry, detail));
    if (v > look.outline.head_from) { // heads neither dry nor yellow
        colour = look.head * (1.0f + look.variation * 0.7f * value);
    }
    return max(colour, vec3(0.0f, 0.0f, 0.0f));
}

// How much of a blade's own colour a pixel can show, by the blade's width in pixels.
SHARED_FN float colour_detail(float width_px) {
    return smoothstep(0.05f, 0.6f, width_px);
}

// Slow variation of a meadow's colour, the same for blades, shells and the ground that stands for
// them; tint 0..1.
SHARED_FN vec3 sward_tint(float tint) {
    return mix(vec3(0.66f, 0.90f, 0.70f), vec3(1.42f, 1.10f, 0.95f), tint);
}

// Sky radiance as grass takes it, the same from everywhere.
SHARED_FN vec3 even_sky(Light light) {
    return mix(light.horizon, light.zenith, 0.6f);
}

// Sunlight that reaches relative height h (0 ground .. 1 top) of a canopy whose ground's normal is
// at cosine `slope` to the sun: the path through the canopy grows as the ground turns away, and
// ends in the hill's own shadow.
SHARED_FN float canopy_sun(Light light, float h, float slope) {
    return exp(-light.sun_extinction * (1.0f - h) / max(slope, 0.12f)) *
           smoothstep(-0.08f, 0.2f, slope);
}

// Skylight likewise: the sky is above, whatever the sun does.
SHARED_FN float canopy_sky(Light light, float h) {
    return exp(-light.sky_extinction * (1.0f - h));
}

// How grass whose blades point along `turn` on average (unit) spreads about it: second moment of
// the cosine to an axis at cosine c. Of blades and leaves at rest; 0 all alike, 1 every way. This,
// the other constants of canopy_sway and kSwayHeight are those that come nearest to rays through
// the shipped meadow: a mean error of 5 percent over views, suns and winds.
SHARED_CONST float kTangentSpread = 0.4f;
SHARED_FN float spread_square(float c) {
    return (1.0f - kTangentSpread) * c * c + kTangentSpread / 3.0f;
}

// Mean of shade_grass's sunlit part over blades so spread, for grey blades of reflectance `grey`.
SHARED_FN float mean_sunlit(GrassAppearance look, float grey, vec3 turn, vec3 sun_way,
                            vec3 to_eye) {
    float against = 0.5f - 0.5f * dot(to_eye, sun_way);
    float diffuse = look.gloss.diffuse *
                    pow(1.0f - spread_square(dot(turn, sun_way)), 0.5f * look.gloss.diffuse_power);
    float th = dot(turn, normalize(sun_way + to_eye + vec3(0.0f, 1e-6f, 0.0f)));
    // A normal spread about th, of variance kTangentSpread / 3, folded with exp(-ps x^2 / 2)
    float wide = 1.0f + look.gloss.specular_power * kTangentSpread / 3.0f;
    float specular =
        look.gloss.specular * exp(-0.5f * look.gloss.specular_power * th * th / wide) / sqrt(wide);
    return grey * (1.0f + 1.1f * look.translucency * against * against * against) * diffuse +
           specular;
}

// W4 as one term: what bending does to the light in a canopy, from `turn`, the direction that it
// gave upright blades (unit). y: factor on the optical depth for sunlight. Blades that lie across
// the light shadow what is below them, blades along it let it through; the depth itself stays that
// of the height at rest, since bending moves no blade above another. x: factor on sunlight. Bent
// blades turn toward the sun or away from it, in more or less shadow; a canopy as a whole still
// takes the light that falls on it, so their mean brightness may leave the calm one's by kSwayRange
// at most and gusts show as waves of that height.
SHARED_CONST float kSwayRange = 0.04f;
SHARED_CONST float kSeenHeight =
    0.35f; // at rest, over the canopy's: where the shadow counts for what one sees
SHARED_CONST float kSwayLoss =
    0.3f; // bent blades open the view to deeper ones: of the fall of `turn`
SHARED_FN vec2 canopy_sway(GrassAppearance look, vec3 turn, vec3 sun_way, vec3 to_eye) {
    vec3 upright = vec3(0.0f, 1.0f, 0.0f);
    float grey = dot(mix(look.root, look.tip, 0.75f), vec3(0.2126f, 0.7152f, 0.0722f));
    float depth =
        sqrt((1.0f - spread_square(dot(turn, sun_way))) / (1.0f - spread_square(sun_way.y)));
    float x = log(mean_sunlit(look, grey, turn, sun_way, to_eye) /
                  max(mean_sunlit(look, grey, upright, sun_way, to_eye), 1e-6f));
    x = x + kSunExtinction * (1.0f - kSeenHeight) * (1.0f - depth) / max(sun_way.y, 0.12f) -
        kSwayLoss * (1.0f - turn.y);
    float kept = kSwayRange *
                 (1.0f - 2.0f / (1.0f + exp(clamp(2.0f * x / kSwayRange, -60.0f, 60.0f)))); // tanh
    return vec2(exp(kept - x), depth);
}

// Light as it reaches grass (and the ground under it) where `sway` is canopy_sway's.
SHARED_FN Light light_in_sway(Light light, vec2 sway) {
    Light here = light;
    here.sun = light.sun * sway.x;
    here.sun_extinction = light.sun_extinction * sway.y;
    return here;
}

// Light on a surface that faces `open_sky` of the sky (1 level .. 0 underneath): the rest of what
// it sees is ground, which gives back half of the sky's light.
SHARED_FN Light light_under(Light light, float open_sky) {
    Light here = light;
    float share = mix(0.5f, 1.0f, open_sky);
    here.zenith = light.zenith * share;
    here.horizon = light.horizon * share;
    return here;
}

// A point of a blade, to be shaded.
struct GrassPoint {
    vec3 albedo;
    vec3 tangent; // unit
    float height; // of the point at rest, 0 ground .. 1 top of the canopy
    float slope;  // cosine between the ground's normal and the sun
};

// Points of many blades, or of one: sums over them of what shading is linear in.
struct GrassSums {
    vec3 sunlit;  // albedo times the share of sunlight that reaches it (canopy_sun)
    vec3 skylit;  // albedo times that of skylight
    float sun;    // that share of sunlight
    vec3 tangent; // unit; of many their axis
    float along; // mean square of the tangents' part along the axis: 1 for one blade, 1/3 every way
                 // alike
};

// GrassSums::along of blades whose mean tangent is so long: 1 for one blade; within 0.05 for blades
// spread about their axis.
SHARED_FN float along_axis(float mean_length) {
    return clamp(1.0f - (4.0f / 3.0f) * (1.0f - mean_length), 1.0f / 3.0f, 1.0f);
}

// Mean square of the tangents' part along `way`, as an eye sees the blades: those that lie along
// the view show the least. From the second moments alone; the fourth as a Gaussian's, scaled to be
// right where all blades are alike and where they point every way.
SHARED_FN float seen_square(GrassSums sums, vec3 way, vec3 to_eye) {
    float across = 0.5f * (1.0f - sums.along);
    float more = sums.along - across;
    float l = dot(sums.tangent, way);
    float v = dot(sums.tangent, to_eye);
    float ll = across + more * l * l;
    float vv = across + more * v * v;
    float lv = across * dot(way, to_eye) + more * l * v;
    float closure = 1.0f / (1.0f + 2.0f * (sums.along * sums.along + 2.0f * across * across));
    float fourth = closure * (ll * vv + 2.0f * lv * lv);
    // A blade's width shows as the sine of its angle to the view, about 1 - v^2 / 2.
    return clamp((ll - 0.5f * fourth) / (1.0f - 0.5f * vv), 0.0f, 1.0f);
}

// Radiance toward the eye (unit direction to_eye) of grass: the one shading function. Of many
// blades the mean of the square of a cosine, and of the highlight as that of a cosine spread by its
// variance.
SHARED_FN vec3 shade_sums(GrassGloss gloss, float translucency, Light light, GrassSums sums,
                          vec3 to_eye) {
    vec3 sun_way = light.to_sun;
    vec3 half_way = normalize(sun_way + to_eye + vec3(0.0f, 1e-6f, 0.0f)); // never of length 0
    float tl = dot(sums.tangent, sun_way);
    float th = dot(sums.tangent, half_way);
    float sunward = tl * tl;
    float mirrored = th * th;
    float wide = 1.0f;
    if (sums.along < 1.0f) {
        sunward = seen_square(sums, sun_way, to_eye);
        float spread = 0.5f * (1.0f - sums.along) * (1.0f - th * th);
        float share =
            seen_square(sums, half_way, to_eye) / max(sums.along * th * th + spread, 1e-4f);
        wide = 1.0f + gloss.specular_power * spread * share;
        mirrored = sums.along * th * th * share / wide;
    }
    float diffuse = gloss.diffuse * pow(max(1.0f - sunward, 0.0f), 0.5f * gloss.diffuse_power);
    float specular =
        gloss.specular * pow(max(1.0f - mirrored, 0.0f), 0.5f * gloss.specular_power) / sqrt(wide);
    // Against the light a blade glows: transmitted sunlight is yellower than reflected.
    float against = 0.5f - 0.5f * dot(to_eye, sun_way);
    vec3 glow = vec3(1.25f, 1.15f, 0.5f) * (translucency * against * against * against);
    vec3 highlight = vec3(specular, specular, specular) * sums.sun;
    return light.sun * (sums.sunlit * (1.0f + glow) * diffuse + highlight) +
           even_sky(light) * sums.skylit;
}

SHARED_FN vec3 shade_grass(GrassAppearance look, Light light, GrassPoint point, vec3 to_eye) {
    GrassSums sums;
    sums.sun = canopy_sun(light, point.height, point.slope);
    sums.sunlit = point.albedo * sums.sun;
    sums.skylit = point.albedo * canopy_sky(light, point.height);
    sums.tangent = point.tangent;
    sums.along = 1.0f;
    return shade_sums(look.gloss, look.translucency, light, sums, to_eye);
}

// Radiance of bare ground under `density` of canopy (0 open).
SHARED_FN vec3 shade_soil(Light light, vec3 albedo, vec3 normal, float density) {
    float slope = dot(normal, light.to_sun);
    float sun = mix(max(slope, 0.0f), max(slope, 0.0f) * canopy_sun(light, 0.0f, slope), density);
    float sky = mix(1.0f, canopy_sky(light, 0.0f), density) * (0.5f + 0.5f * normal.y);
    return albedo * (light.sun * sun + even_sky(light) * sky);
}

SHARED_END
#endif
