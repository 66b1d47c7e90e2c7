// SPDX-License-Identifier: Apache-2.0
// In: the drawn scene, the canopy's upper surface, one kind's textures. Out: the scene resolved,
// seen through the far field: the pixel's ray is marched through the canopy, front to back, from
// where it enters it (docs/far-field.md). Variants: COLUMNS, else slabs; CREST, of any kind, for
// rays that may leave the canopy and come to another: few, and the longest to compile.
#include "lib/resolved.glsl"
#include "lib/tiers.glsl"
#include "shells/march_view.glsl"
#include "shared/march_light.h"
#include "shared/sward.h"
#include "shared/tile_lie.h"
#include "shells/march_texels.glsl"

in vec2 ndc;
#if defined(CREST) && !defined(SURFACE)
#include "shells/crest_ray.glsl"
#endif
#ifdef COUNT
layout(early_fragment_tests)
    in; // a shader that writes to memory would run for pixels of other kinds too
layout(std430, binding = BIND_MARCH_COUNTS) buffer Counts {
    uint all_steps;
    uint all_reads;
};
const int kReadsAPixel = 19; // choice and march: canopy 3 each; its samples 4, depths 4, colours 4,
                             // correction 1; factors on light are a stretch's
int steps_taken = 0, texels_read = kReadsAPixel;
#endif

#ifdef CREST
const int kStretches =
    5; // of one ray through the canopy: over crests, and along ground that curves away
#else
const int kStretches = 1;
#endif
const float kOnGround = 0.9; // of the way to the ground: what stands beyond is the ground
const float kSpread = 0.6;   // of a pixel's length along the ground: its samples see ground so far
                             // before its middle
const float kCrestLevel = 0.4; // of the mean slope at a crest: the samples that see the least of it
const float kFacetSlope = 1e-4, // the land as drawn may differ so much in slope from the land, for
    kFacetSlopeMost = 0.15;     // a metre of distance; at most

// What the march has gathered.
struct Seen {
    GrassSums grass;
    vec4 through;   // share of each sample's light that comes through
    float half_way; // distance at which half of the first sample's light is gone (m)
};

// Is the kind columns?
bool shows_columns() {
#ifdef CREST
    return kind == kMarchColumns;
#elif defined(COLUMNS)
    return true;
#else
    return false;
#endif
}

float mean_of(vec4 samples_of_a_pixel) {
    return dot(samples_of_a_pixel, vec4(0.25));
}

// march_step() of the kinds that the program shows.
MarchStep step_from(MarchPath path, MarchPlan plan, inout MarchWalk walk, vec2 number_scale) {
#ifdef CREST
    return march_step(path, plan, walk, number_scale);
#elif defined(COLUMNS)
    return march_column(path, plan, walk, number_scale);
#else
    return march_slab(path, plan, walk, number_scale);
#endif
}

// Share of the optical depth there that the near tier leaves.
float far_share(vec3 world) {
    float share = march_share(handover_share(distance(world, frame.lod_eye), frame.handover_band));
    return frame.far_alone != 0 || frame.handover_mode == kHandoverOff ? 1.0 : share;
}

// Tint of the sward where what is seen of it stands, as the pixel's footprint on the ground shows
// it.
float tint_of(View view, Entry entry, MarchPath path, MarchPlan plan, float half_way) {
#ifdef SURFACE
    return entry.ground.w;
#else
    float seen = half_way < kNever ? half_way : entry.distance + min(ground_reach(path), plan.run);
    vec2 xz = frame.eye.xz + view.way.xz * min(seen, kFarthest);
    return sward_patches(xz, ivec2(frame.anchor_x, frame.anchor_z),
                         has_land() ? ground_surface(xz, plan.footprint).tint : entry.ground.w,
                         max(plan.footprint, 0.5 * plan.stretch));
#endif
}

// So far along the ray what a sample shows is an object; what is farther is the ground, to which
// the path comes by itself. Samples of one pixel see the ground as far apart as the pixel is long
// on it: far away that is more than the ray's whole way through the canopy.
float nearest_ground(Entry entry, MarchPath path, MarchPlan plan) {
    float fall = -path.height.y;
    float steeper = fall + min(kFacetSlope * entry.distance, kFacetSlopeMost);
    float reach = min(path.height.x / max(steeper, 1e-4), kNever);
    float level = fall * (is_crest_mean(path) ? kCrestLevel : 1.0);
    return kOnGround * reach - kSpread * plan.footprint / max(level, 2e-3);
}

// The canopy from an entry on, until it is opaque, the ray has left it or is on the ground, or the
// path has come to its end. `radiance`: of what was seen of it.
MarchWalk march(View view, Entry entry, MarchPath path, vec4 scene, inout Seen seen,
                out vec3 radiance) {
    MarchPlan plan = plan_of(view, entry, path);
    plan.kind = kind;
    march_settle(plan);
    vec2 factors = correction_at(plan);
    float scale = plan.density * factors.x * bears_any(entry, plan);
    Light light = light_at(entry);
    vec3 normal = normal_at(entry);
    float slope = dot(normal, frame.light.to_sun); // both in the world
    float steepness = march_steepness(plan, path.way.y);
    float ground = nearest_ground(entry, path, plan);
    vec4 ends = mix(scene - entry.distance, vec4(kNever),
                    greaterThan(scene - entry.distance, vec4(ground)));
    seen.grass = march_nothing();
#if defined(CREST) || defined(SURFACE)
    MarchWalk walk = march_begin_inside(path);
#else
    MarchWalk walk = march_begin(path);
#endif
    float before_it = near_reach() - entry.distance;
    if (before_it > 0.0) {
        march_advance(path, walk, vec3(before_it, 1e9, scale));
    }
    float last = max(max(ends.x, ends.y), max(ends.z, ends.w));
    for (int n = 0; n < kMarchSteps && march_inside(path, walk) && walk.s < last &&
                    mean_of(seen.through) > kMarchEnd;
         ++n) {
        MarchStep taken = step_from(path, plan, walk, vec2(float(n), scale));
        Texel at = texel_of(plan, taken);
        vec4 texel = textureLod(densities, at.uv, taken.mip - march_base(kind));
        float depth = scale * taken.depth * texel.a * land_share(entry, plan, taken.rest);
        float middle = entry.distance + 0.5 * (taken.span.x + taken.span.y);
        depth *= far_share(frame.eye + view.way * middle);
        depth = march_beside(depth);
        vec4 part = clamp((ends - taken.span.x) / max(taken.span.y - taken.span.x, 1e-6), 0.0, 1.0);
        vec4 lost = seen.through * (1.0 - exp(-depth * part));
        vec3 albedo = texel.rgb / max(texel.a, 1e-4);
        albedo *= shows_columns() ? march_tint(taken.layer, steepness) : vec3(1.0);
        float shown = mean_of(lost);
        march_gather(seen.grass, light, slope,
                     MarchBlades(albedo, land_tangent(entry, mean_tangent(path, taken, at, shown)),
                                 taken.rest.y / frame.canopy_m, shown));
        bool more = seen.through.x > 0.5;
        seen.through -= lost;
        seen.half_way = more && seen.through.x <= 0.5 ? middle : seen.half_way;
#ifdef COUNT
        ++steps_taken;
        texels_read += shows_fibres(taken, shown) ? 2 : 1;
#endif
    }
    vec3 to_eye = to_eye_at(entry, view);
    float level = length(to_eye.xz);
    float fall = max(-path.height.y, 0.0);
    march_stand(seen.grass, light,
                MarchGround(atan(fall, level) * (180.0 / kPi), rise_at(entry, view), slope),
                to_eye);
#ifdef COUNT
    ++texels_read;
#endif
    radiance = march_radiance(light, seen.grass, to_eye) * factors.y *
               sward_tint(tint_of(view, entry, path, plan, seen.half_way)) *
               light_factor(to_eye, light.to_sun.xyz, entry.air.xy,
                            fall * inversesqrt(fall * fall + level * level));
    return walk;
}

// Distances along the ray to what each sample shows.
vec4 scene_of(View view, ivec2 pixel) {
    vec4 scene;
    for (int i = 0; i < 4; ++i) { // fewer samples count more than once
        float depth = texelFetch(scene_depth, pixel, i * samples / 4).r;
        scene[i] = depth > 0.0 ? frame.near_m / (depth * view.axis) : kNever;
    }
    return scene;
}

// Resolves the pixel: what is seen of the grass, and the scene that comes through it.
void write_pixel(ivec2 pixel, vec3 radiance, vec4 through) {
    float left = mean_of(through);
    if (left <= kMarchEnd) { // what a march to the end would still have found looks as what it has
        out_color = vec4(radiance / (1.0 - left), 1.0);
#ifdef COUNT
        texels_read -= 4;
#endif
        return;
    }
    out_color = vec4(radiance, 1.0 - left);
    for (int i = 0; i < 4; ++i) {
        out_color += 0.25 * through[i] * texelFetch(scene_color, pixel, i * samples / 4);
    }
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    View view = view_of(pixel, ndc);
    vec4 scene = scene_of(view, pixel);
    float farthest = max(max(scene.x, scene.y), max(scene.z, scene.w));
    Entry entry = entry_of(view, pixel);
    vec4 members = vec4(1.0);
    vec3 normal = normal_at(entry);
    vec3 radiance = vec3(0.0);
    vec4 through = vec4(1.0);
    float half_way = kNever;
#if defined(CREST) && !defined(SURFACE)
    vec4 entries = eye_place.x > 0.5 ? vec4(entry.distance) : sample_entries(view, pixel);
    Ray ray = Ray(view, entry, members, false);
    if (misses(entry, entries) || dot(members_of(view, entries, entry.ground.xy), members) < 4.0) {
        ray.fresh = true;
        ray.members = vec4(0.0);
    }
#endif
    for (int stretch = 0; stretch < kStretches && mean_of(through) > kMarchEnd; ++stretch) {
#ifndef SURFACE
#ifdef CREST
        if (ray.fresh) {
            ray = nearest_ray(pixel, ray.members, entries);
        }
        view = ray.view;
        entry = ray.entry;
        members = ray.members;
#endif
        entry = settled(view, entry);
#endif
        if (entry.distance >= farthest) {
            break;
        }
        Seen seen = Seen(march_nothing(), through, kNever);
        MarchPath path = path_of(view, entry);
        vec3 grass;
        MarchWalk walk = march(view, entry, path, mix(vec4(-1.0), scene, members), seen, grass);
        half_way = min(half_way, seen.half_way);
        AirLight air = haze_of(view.way * min(seen.half_way, entry.distance + 1.0));
        radiance += grass * air.through + air.added * mean_of(through - seen.through);
        through = seen.through;
#ifdef CREST
#ifdef SURFACE
        entry = entry_behind(view, pixel, entry);
#else
        entries = mix(entries, vec4(kNever), greaterThan(members, vec4(0.5)));
        ray.entry = entry;
        ray = ray_after(ray, path, walk, scene, entries);
#endif
#endif
    }
    write_first_sample(pixel);
    write_pixel(pixel, radiance, through);
    if (through.x < 0.5) {
        out_data.x = min(half_way, farthest) * view.axis;
#ifdef AOV
        float slice = abs(view.way.x) > abs(view.way.z) ? kTierSliceX : kTierSliceZ;
        float tier = shows_columns() ? kTierShell : slice;
        out_data.yz = vec2(tier, 0.5);
        out_tangent = vec4(0.0, 1.0, 0.0, 0.0);
        out_normal = vec4(normal, 0.0);
#endif
    }
#ifdef COUNT
    atomicAdd(all_steps, uint(steps_taken));
    atomicAdd(all_reads, uint(texels_read));
#endif
}
