// SPDX-License-Identifier: Apache-2.0
// In: the drawn scene, the canopy's upper surface, one kind's textures. Out: the scene resolved, seen through the far field: the pixel's ray is
// marched through the canopy, front to back, from where it enters it (docs/far-field.md). Variants: COLUMNS, else slabs;
// CREST, for rays that may leave the canopy and come to another.
#include "lib/resolved.glsl"
#include "lib/tiers.glsl"
#include "shells/march_view.glsl"

layout(binding = TEX_MARCH_DENSITY) uniform sampler2DArray densities;
layout(binding = TEX_MARCH_FIBRES) uniform sampler2DArray fibres;
layout(binding = TEX_MARCH_CORRECTION) uniform sampler2DArray correction;
uniform int kind;
in vec2 ndc;

const float kHorizon = 50000.0;   // nobody sees grass beyond (m)
const int kStretches = 5;         // of one ray through the canopy: over crests, and along ground that curves away
const float kOnGround = 0.9;      // of the way to the ground: what stands beyond is the ground
const float kFibresFrom = 3.5, kFibresTo = 4.5; // mips: beyond, tangents are the layer's mean
const float kOtherDensity = 0.4;  // of the correction's second image

// What the march has gathered.
struct Seen {
    GrassSums grass;  // tangent: a sum, not yet an axis
    vec4 through;     // share of each sample's light that comes through
    float half_way;   // distance at which half of the light is gone (m)
};

Seen nothing_seen(vec4 through) {
    return Seen(GrassSums(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 1.0), through, kNever);
}

float mean_of(vec4 samples_of_a_pixel) {
    return dot(samples_of_a_pixel, vec4(0.25));
}

float correction_at(MarchPlan plan) {
    vec2 size = vec2(float(kMarchElevations), float(kMarchMips));
    vec2 uv = (vec2(plan.table.y, plan.table.x) + 0.5) / size;
    float thin = clamp((1.0 - plan.density) / (1.0 - kOtherDensity), 0.0, 1.3);
    return max(mix(textureLod(correction, vec3(uv, 0.0), 0.0)[kind], textureLod(correction, vec3(uv, 1.0), 0.0)[kind], thin), 0.05);
}

vec3 texel_place(MarchPlan plan, MarchStep taken) {
    vec2 place = (taken.rest.xz + frame.patch_grid.xy) / frame.patch_grid.z;
    int variant = tile_variant(ivec2(floor(place)) + frame.patch_tile.xy, frame.patch_tile.z);
    return march_texel(plan, taken, vec3(place, float(variant)));
}

// Mean tangent of the blades at a step, as the wind turns them: read where a pixel tells blades apart, else the layer's.
vec3 mean_tangent(MarchPath path, MarchStep taken, vec3 uv, float mip) {
    vec4 texel = textureLod(fibres, uv, mip);
    vec3 upright = mix(vec3(2.0 * texel.x - 1.0, texel.y, 2.0 * texel.z - 1.0), vec3(0.0, medium.layers[taken.layer].x, 0.0),
                       smoothstep(kFibresFrom, kFibresTo, taken.mip));
    vec2 turn = march_turn(path.bend.z * taken.rest.y);
    return vec3(upright.x, 0.0, upright.z) + upright.y * vec3(path.bend.x * turn.x, turn.y, path.bend.y * turn.x);
}

// Share of the blades there that the near tier leaves.
float far_share(vec3 world) {
    float share = 1.0 - handover_share(distance(world, frame.lod_eye.xyz), frame.handover.xy);
    return frame.mode.z != 0 || frame.mode.x == kHandoverOff ? 1.0 : share;
}

// What the sums hold, as radiance.
vec3 light_of(Seen seen, View view, Entry entry) {
    Light light = light_at(entry);
    GrassSums grass = seen.grass;
    float shown = max(grass.along, 1e-6);
    float evenness = length(grass.tangent);
    grass.along = along_axis(evenness / shown);
    grass.tangent /= max(evenness, 1e-6);
    vec3 tint = sward_tint(entry.ground.w);
    grass.sunlit *= tint;
    grass.skylit *= tint;
    return shade_sums(medium.look, medium.size.z, light, grass, to_eye_at(entry, view));
}

// Adds a step's blades, `shown` of the pixel, to the sums.
void gather(inout Seen seen, MarchStep taken, vec4 texel, vec3 tangent, vec3 tint_slope_shown) {
    float height = taken.rest.y / frame.patch_grid.w;
    float shown = tint_slope_shown.z;
    vec3 albedo = texel.rgb * (shown / max(texel.a, 1e-4));
#ifdef COLUMNS
    albedo *= mix(medium.level_tint[taken.layer], medium.steep_tint[taken.layer], tint_slope_shown.x).rgb;
#endif
    float sun = canopy_sun(frame.light, height, tint_slope_shown.y);
    seen.grass.sunlit += albedo * sun;
    seen.grass.skylit += albedo * canopy_sky(frame.light, height);
    seen.grass.sun += shown * sun;
    seen.grass.tangent += tangent * shown;
    seen.grass.along += shown; // until light_of: the share of the pixel
}

// The canopy from an entry on, until it is opaque, the ray has left it or is on the ground, or the path has come to its end.
MarchWalk march(View view, Entry entry, MarchPath path, vec4 scene, inout Seen seen) {
    MarchPlan plan = plan_of(view, entry, path);
    plan.kind = kind;
    march_settle(plan);
    float scale = plan.density * correction_at(plan) * step(0.0021, entry.ground.z);
    vec3 normal = normal_at(entry);
    vec3 crossed = abs(vec3(medium.edges[0]) * vec3(plan.level.x, path.way.y, plan.level.y));
    vec3 tint_slope_shown = vec3(crossed.y / max(crossed.x + crossed.y + crossed.z, 1e-6), dot(normal, frame.light.to_sun.xyz), 0.0);
    seen.grass.along = 0.0;
    float ground = kOnGround * ground_reach(path);
    vec4 ends = mix(scene - entry.distance, vec4(kNever), greaterThan(scene - entry.distance, vec4(ground)));
#if defined(CREST) || defined(SURFACE)
    MarchWalk walk = march_begin_inside(path);
#else
    MarchWalk walk = march_begin(path);
#endif
    for (int n = 0; n < kMarchSteps && march_inside(path, walk) && mean_of(seen.through) > kMarchEnd; ++n) {
        MarchStep taken = march_step(path, plan, walk, vec2(float(n), scale));
        vec3 uv = texel_place(plan, taken);
        float mip = taken.mip - march_base(kind);
        vec4 texel = textureLod(densities, uv, mip);
        float depth = scale * taken.depth * texel.a;
        float middle = entry.distance + 0.5 * (taken.span.x + taken.span.y);
        depth *= far_share(frame.eye.xyz + view.way * middle);
        vec4 part = clamp((ends - taken.span.x) / max(taken.span.y - taken.span.x, 1e-6), 0.0, 1.0);
        vec4 lost = seen.through * (1.0 - exp(-depth * part));
        tint_slope_shown.z = mean_of(lost);
        gather(seen, taken, texel, mean_tangent(path, taken, uv, mip), tint_slope_shown);
        float before = mean_of(seen.through);
        seen.through -= lost;
        seen.half_way = before > 0.5 && mean_of(seen.through) <= 0.5 ? middle : seen.half_way;
    }
    return walk;
}

#if defined(CREST) && !defined(SURFACE)
// Beyond a crest: where the ray comes down into a canopy of this height again, before `last`; else kNever.
float next_entry(View view, float from, float last, float canopy) {
    const int kProbes = 20, kHalvings = 8;
    float low = from, high = kNever;
    float ratio = pow(max(last / from, 1.0001), 1.0 / float(kProbes));
    float t = from;
    for (int i = 0; i < kProbes && high >= kNever; ++i) {
        t *= ratio;
        vec3 at = frame.eye.xyz + view.way * t;
        bool under = at.y - ground_at(at.xz) < canopy;
        low = under ? low : t;
        high = under ? t : high;
    }
    for (int i = 0; i < kHalvings && high < kNever; ++i) {
        t = 0.5 * (low + high);
        vec3 at = frame.eye.xyz + view.way * t;
        bool under = at.y - ground_at(at.xz) < canopy;
        low = under ? low : t;
        high = under ? t : high;
    }
    return high;
}

// Where the ray goes on after a stretch; distance kNever: nowhere.
Entry entry_after(View view, Entry entry, MarchPath path, MarchWalk walk, float farthest) {
    Entry next = entry;
    bool over_it = walk.layer >= kMarchLayers;
    next.height = over_it ? path.bend.w : march_height(path, walk.s);
    next.distance = entry.distance + walk.s;
    if (over_it) {
        next.distance = next_entry(view, next.distance + 0.1, min(farthest, kHorizon), next.height);
    }
    next.ground = ground_under(frame.eye.xz + view.way.xz * min(next.distance, kHorizon));
    next.distance = walk.layer < 0 ? kNever : next.distance;
    return next;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    View view = view_of(pixel, ndc);
    vec4 scene; // distance along the ray to what each sample shows
    for (int i = 0; i < 4; ++i) { // fewer samples count more than once
        float depth = texelFetch(scene_depth, pixel, i * samples / 4).r;
        scene[i] = depth > 0.0 ? kNear_m / (depth * view.axis) : kNever;
    }
    float farthest = max(max(scene.x, scene.y), max(scene.z, scene.w));
    Entry entry = entry_of(view, pixel);
    vec3 normal = normal_at(entry);
    vec3 radiance = vec3(0.0);
    vec4 through = vec4(1.0);
    float half_way = kNever;
#ifdef CREST
    for (int stretch = 0; stretch < kStretches && entry.distance < farthest && mean_of(through) > kMarchEnd; ++stretch) {
#else
    if (entry.distance < farthest) {
#endif
        Seen seen = nothing_seen(through);
        MarchPath path = path_of(view, entry);
        MarchWalk walk = march(view, entry, path, scene, seen);
        half_way = min(half_way, seen.half_way);
        vec4 haze = haze_of(frame.light, view.way * min(seen.half_way, entry.distance + 1.0));
        radiance += light_of(seen, view, entry) * haze.a + haze.rgb * mean_of(through - seen.through);
        through = seen.through;
#ifdef CREST
#ifdef SURFACE
        entry = second_entry(view, pixel);
#else
        entry = entry_after(view, entry, path, walk, farthest);
#endif
#endif
    }
    float left = mean_of(through);
    if (left <= kMarchEnd) { // what a march to the end would still have found looks as what it has
        radiance /= 1.0 - left;
        through = vec4(0.0);
    }
    write_first_sample(pixel);
    out_color = vec4(radiance, 1.0 - mean_of(through));
    for (int i = 0; i < 4; ++i) {
        out_color += 0.25 * through[i] * texelFetch(scene_color, pixel, i * samples / 4);
    }
    if (through.x < 0.5) {
        out_data.x = min(half_way, farthest) * view.axis;
#ifdef AOV
#ifdef COLUMNS
        float tier = kTierShell;
#else
        float tier = abs(view.way.x) > abs(view.way.z) ? kTierSliceX : kTierSliceZ;
#endif
        out_data.yz = vec2(tier, 0.5);
        out_tangent = vec4(0.0, 1.0, 0.0, 0.0);
        out_normal = vec4(normal, 0.0);
#endif
    }
}
