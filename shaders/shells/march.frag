// SPDX-License-Identifier: Apache-2.0
// In: the drawn scene, the canopy's upper surface. Out: the scene resolved, seen through the far field: each pixel's ray is marched
// through the canopy, front to back, from where it enters it (docs/far-field.md).
#include "lib/ground.glsl"
#include "lib/resolved.glsl"
#include "lib/sway.glsl"
#include "lib/tiers.glsl"
#include "shared/bend.h"
#include "shared/march_medium.h"

layout(std140, binding = BIND_MARCH) uniform MarchBlock { MarchMedium medium; };
#include "shared/march.h"

layout(binding = TEX_MARCH_DENSITY) uniform sampler2DArray densities[kMarchSets + 1];
layout(binding = TEX_MARCH_FIBRES) uniform sampler2DArray fibres[kMarchSets + 1];
layout(binding = TEX_MARCH_CORRECTION) uniform sampler2DArray correction;
layout(binding = TEX_CANOPY_DEPTH) uniform sampler2D canopy_depth;
layout(binding = TEX_CANOPY_GROUND) uniform sampler2D canopy_ground;
layout(binding = TEX_CANOPY_AIR) uniform sampler2D canopy_air;
uniform float eye_height; // over the ground (m)
in vec2 ndc;

const float kNever = 1e9;
const float kHorizon = 50000.0;   // nobody sees grass beyond (m)
const int kStretches = 5;         // of one ray through the canopy: over crests, and along ground that curves away
const float kOnGround = 0.9;      // of the way to the ground: what stands beyond is the ground
const float kFibresFrom = 3.5, kFibresTo = 4.5; // mips: beyond, tangents are the layer's mean
const float kOtherDensity = 0.4;  // of the correction's second image

struct View {
    vec3 way;       // of the pixel's ray, unit
    vec4 scene;     // distance along it to what each sample shows
    float dither;
};

// What lies over the ground where a ray enters the canopy.
struct Place {
    vec4 ground; // slope, density, tint
    vec4 air;    // wind, canopy_sway
};

// What the march has gathered.
struct Seen {
    vec3 radiance;
    vec4 through; // share of each sample's light that comes through
    float half_way; // distance at which half of the light is gone
    int kind, axis;
};

MarchPath path_of(View view, Place place, float entry, float height) {
    MarchPath path;
    vec3 at = frame.eye.xyz + view.way * entry;
    float canopy = frame.patch_grid.w;
    float speed = length(place.air.xy);
    float bend = 0.5 * kPi * bend_intensity(speed, frame.wind.mean.w) / canopy;
    path.bend = vec4(place.air.xy / max(speed, 1e-4), bend, 0.0);
    path.bend.w = march_bent_height(path, canopy);
    height = min(height, path.bend.w);
    path.from = vec3(at.x, height, at.z);
    path.way = view.way;
    float fall = view.way.y - dot(place.ground.xy, view.way.xz);
    float reach = fall < 0.0 ? min(height / -fall, 40.0 * canopy + 0.02 * entry) : 40.0 * canopy;
    path.height = vec4(height, fall, 0.0, kNever);
    if (reach > canopy * 3.0) { // low over the ground: it curves under the ray
        vec2 ahead = at.xz + reach * view.way.xz;
        float rise = ground_at(ahead) - ground_at(at.xz) - dot(place.ground.xy, ahead - at.xz);
        path.height.z = -rise / (reach * reach);
    }
    path.height.w = 1.5 * reach + 0.1 * canopy; // beyond, the ground is another one
    return path;
}

float correction_at(MarchPlan plan) {
    vec2 size = vec2(float(kMarchElevations), float(kMarchMips));
    vec2 uv = (vec2(plan.table.y, plan.table.x) + 0.5) / size;
    float thin = clamp((1.0 - plan.density) / (1.0 - kOtherDensity), 0.0, 1.3);
    return max(mix(texture(correction, vec3(uv, 0.0))[plan.kind], texture(correction, vec3(uv, 1.0))[plan.kind], thin), 0.05);
}

vec3 texel_place(MarchPlan plan, MarchStep taken) {
    vec2 place = (taken.rest.xz + frame.patch_grid.xy) / frame.patch_grid.z;
    int variant = tile_variant(ivec2(floor(place)) + frame.patch_tile.xy, frame.patch_tile.z);
    return march_texel(plan, taken, vec3(place, float(variant)));
}

// A sampler of an array may be picked by a number that is the same for all alone.
vec4 density_at(int kind, vec3 uv, float mip) {
    return kind == 0 ? textureLod(densities[0], uv, mip) : kind == 1 ? textureLod(densities[1], uv, mip)
         : kind == 2 ? textureLod(densities[2], uv, mip) : textureLod(densities[3], uv, mip);
}
vec4 fibres_at(int kind, vec3 uv, float mip) {
    return kind == 0 ? textureLod(fibres[0], uv, mip) : kind == 1 ? textureLod(fibres[1], uv, mip)
         : kind == 2 ? textureLod(fibres[2], uv, mip) : textureLod(fibres[3], uv, mip);
}

// Mean tangent of the blades at a step, as the wind turns them: read where a pixel tells blades apart, else the layer's.
vec3 mean_tangent(MarchPath path, MarchPlan plan, MarchStep taken, vec3 uv) {
    vec3 upright = vec3(0.0, medium.layers[taken.layer].x, 0.0);
    float told = 1.0 - smoothstep(kFibresFrom, kFibresTo, taken.mip);
    if (told > 0.0) {
        vec4 texel = fibres_at(plan.kind, uv, taken.mip - march_base(plan.kind));
        upright = mix(upright, vec3(2.0 * texel.x - 1.0, texel.y, 2.0 * texel.z - 1.0), told);
    }
    float angle = path.bend.z * taken.rest.y;
    return vec3(upright.x, 0.0, upright.z) + upright.y * vec3(path.bend.x * sin(angle), cos(angle), path.bend.y * sin(angle));
}

// Share of the blades there that the near tier leaves.
float far_share(vec3 world) {
    if (frame.mode.z != 0 || frame.mode.x == kHandoverOff) {
        return 1.0;
    }
    return 1.0 - handover_share(distance(world, frame.lod_eye.xyz), frame.handover.xy);
}

// Where a stretch ended: distance along the ray, kNever where nothing is left to see; height over the ground there.
struct Left {
    float distance, height;
};

Left left_at(MarchPath path, MarchWalk walk, float entry) {
    return Left(walk.layer < 0 ? kNever : entry + walk.s, walk.layer >= kMarchLayers ? path.bend.w : march_height(path, walk.s));
}

// The canopy from `entry` on, until it is opaque, the ray has left it or is on the ground, or the path has come to its end.
Left march(View view, Place place, MarchPath path, float entry, MarchPlan plan, inout Seen seen) {
    march_settle(plan);
    seen.kind = plan.kind;
    seen.axis = plan.axis;
    float scale = plan.density * correction_at(plan);
    vec3 normal = normalize(vec3(-place.ground.x, 1.0, -place.ground.y));
    float slope = dot(normal, frame.light.to_sun.xyz);
    Light light = light_in_sway(frame.light, place.air.zw);
    vec3 tint = sward_tint(place.ground.w);
    vec3 crossed = abs(vec3(medium.edges[0]) * vec3(plan.level.x, view.way.y, plan.level.y));
    float steep = crossed.y / max(crossed.x + crossed.y + crossed.z, 1e-6);
    bool handing_over = entry < frame.handover.y + frame.patch_grid.z;
    MarchWalk walk = march_begin(path);
    vec4 ends = mix(view.scene - entry, vec4(kNever), greaterThan(view.scene - entry, vec4(kOnGround * min(path.height.x / max(-path.height.y, 1e-4), kNever))));
    for (int n = 0; n < kMarchSteps && march_inside(path, walk); ++n) {
        MarchStep taken = march_step(path, plan, walk, vec2(float(n), scale));
        vec3 uv = texel_place(plan, taken);
        vec4 texel = density_at(plan.kind, uv, taken.mip - march_base(plan.kind));
        float depth = scale * taken.depth * texel.a;
        float middle = entry + 0.5 * (taken.span.x + taken.span.y);
        if (handing_over) {
            depth *= far_share(frame.eye.xyz + view.way * middle);
        }
        vec4 part = clamp((ends - taken.span.x) / max(taken.span.y - taken.span.x, 1e-6), 0.0, 1.0);
        vec4 lost = seen.through * (1.0 - exp(-depth * part));
        float weight = dot(lost, vec4(0.25));
        if (weight > 1e-4) {
            vec3 tangent = mean_tangent(path, plan, taken, uv);
            float evenness = length(tangent);
            vec3 albedo = texel.rgb / max(texel.a, 1e-4) * tint;
            if (plan.kind == kMarchColumns) {
                albedo *= mix(medium.level_tint[taken.layer], medium.steep_tint[taken.layer], steep).rgb;
            }
            GrassPoint point = GrassPoint(albedo, tangent / evenness, taken.rest.y / frame.patch_grid.w, slope, along_axis(evenness));
            seen.radiance += weight * shade_fibres(medium.look, medium.size.z, light, point, -view.way);
        }
        if (dot(seen.through, vec4(0.25)) > 0.5 && dot(seen.through - lost, vec4(0.25)) <= 0.5) {
            seen.half_way = middle;
        }
        seen.through -= lost;
        if (all(lessThan(seen.through, vec4(kMarchEnd)))) {
            seen.radiance /= 1.0 - dot(seen.through, vec4(0.25));
            seen.through = vec4(0.0);
            return Left(kNever, 0.0);
        }
    }
    return left_at(path, walk, entry);
}

// The canopy from `entry` on, by the kinds of texture that its footprint and elevation ask for. Returns likewise.
Left see(View view, Place place, MarchPath path, float entry, inout Seen seen) {
    if (place.ground.z <= 0.002) {
        MarchWalk walk = march_begin(path);
        march_advance(path, walk, vec3(kNever, kNever, 1.0));
        return left_at(path, walk, entry);
    }
    MarchPlan plan = march_look(path, vec3(1.0 / frame.eye.w, entry, place.ground.z));
    vec2 shares = march_shares(plan);
    int set = march_slab_set(plan, view.dither);
    Left left = Left(kNever, 0.0);
    Seen before = seen;
    vec3 radiance = vec3(0.0);
    vec4 through = vec4(0.0);
    for (int i = 0; i < 3; ++i) { // columns, slabs across x, slabs across z
        float share = i == 0 ? shares.x : (1.0 - shares.x) * (i == 1 ? shares.y : 1.0 - shares.y);
        if (share <= 0.001) {
            continue;
        }
        plan.kind = i == 0 ? kMarchColumns : set;
        plan.axis = i == 2 ? 1 : 0;
        Seen one = before;
        left = march(view, place, path, entry, plan, one);
        radiance += share * one.radiance;
        through += share * one.through;
        if (share >= 0.33) {
            seen = one;
        }
    }
    seen.radiance = radiance;
    seen.through = through;
    return left;
}

// Beyond a crest: where the ray comes down into the canopy again, before `last`; else kNever.
float next_entry(View view, float from, float last, float canopy) {
    const int kProbes = 20;
    float low = from, high = kNever;
    float ratio = pow(max(last / from, 1.0001), 1.0 / float(kProbes));
    for (int i = 1; i <= kProbes; ++i) {
        float t = from * pow(ratio, float(i));
        vec3 at = frame.eye.xyz + view.way * t;
        if (at.y - ground_at(at.xz) < canopy) {
            high = t;
            break;
        }
        low = t;
    }
    for (int i = 0; i < 8 && high < kNever; ++i) {
        float t = 0.5 * (low + high);
        vec3 at = frame.eye.xyz + view.way * t;
        bool under = at.y - ground_at(at.xz) < canopy;
        low = under ? low : t;
        high = under ? t : high;
    }
    return high;
}

Place place_at(View view, float t, vec4 air) {
    vec2 xz = frame.eye.xz + view.way.xz * t;
    Ground ground = ground_surface(xz);
    return Place(vec4(-ground.normal.xz / max(ground.normal.y, 0.1), ground.density, ground.tint), air);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    View view;
    view.way = normalize(near.xyz / near.w - frame.eye.xyz);
    float axis = (frame.clip_from_world * vec4(view.way, 0.0)).w; // distance along the view axis, for a metre of the ray
    vec4 colours[4];
    for (int i = 0; i < 4; ++i) {
        int n = min(i, samples - 1);
        float depth = texelFetch(scene_depth, pixel, n).r;
        view.scene[i] = depth > 0.0 ? kNear_m / (depth * axis) : kNever;
        colours[i] = texelFetch(scene_color, pixel, n);
    }
    view.dither = pixel_threshold(pixel);

    float depth = texelFetch(canopy_depth, pixel, 0).r;
    Place place = Place(texelFetch(canopy_ground, pixel, 0), texelFetch(canopy_air, pixel, 0));
    float entry = depth > 0.0 ? kNear_m / (depth * axis) : kNever;
    float height = frame.patch_grid.w;
    if (eye_height < frame.patch_grid.w) { // the eye may stand in the canopy
        vec2 wind = wind_at(frame.eye.xz);
        if (eye_height < frame.patch_grid.w + bend_offset(frame.patch_grid.w, frame.patch_grid.w, wind, frame.wind.mean.w).y + kNear_m) {
            entry = kNear_m;
            height = eye_height;
            place = place_at(view, 0.0, vec4(wind, sway_at(frame.eye.xyz - vec3(0.0, eye_height, 0.0), wind).xy));
        }
    }
    Seen seen = Seen(vec3(0.0), vec4(1.0), kNever, kMarchColumns, 0);
    float farthest = max(max(view.scene.x, view.scene.y), max(view.scene.z, view.scene.w));
    for (int stretch = 0; stretch < kStretches && entry < farthest; ++stretch) {
        vec3 before = seen.radiance;
        vec4 share = seen.through;
        MarchPath path = path_of(view, place, entry, height);
        Left left = see(view, place, path, entry, seen);
        vec4 haze = haze_of(frame.light, view.way * min(seen.half_way, entry + 1.0));
        seen.radiance = before + (seen.radiance - before) * haze.a + haze.rgb * dot(share - seen.through, vec4(0.25));
        if (left.distance >= kNever || stretch + 1 == kStretches || all(lessThan(seen.through, vec4(kMarchEnd)))) {
            break;
        }
        bool over_it = left.height > 0.999 * path.bend.w;
        height = over_it ? path.bend.w : left.height;
        entry = over_it ? next_entry(view, left.distance + 0.1, min(farthest, kHorizon), height) : left.distance;
        place = place_at(view, entry, place.air);
    }
    write_first_sample(pixel);
    out_color = vec4(seen.radiance, 1.0 - dot(seen.through, vec4(0.25)));
    for (int i = 0; i < 4; ++i) {
        out_color += 0.25 * seen.through[i] * colours[i];
    }
    if (seen.through.x < 0.5) {
        out_data.x = min(seen.half_way, farthest) * axis;
#ifdef AOV
        out_data.yz = vec2(seen.kind == kMarchColumns ? kTierShell : seen.axis == 0 ? kTierSliceX : kTierSliceZ, 0.5);
        out_tangent = vec4(0.0, 1.0, 0.0, 0.0);
        out_normal = vec4(normalize(vec3(-place.ground.x, 1.0, -place.ground.y)), 0.0);
#endif
    }
}
