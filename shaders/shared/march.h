// SPDX-License-Identifier: Apache-2.0
// The far field's march: where a ray through the canopy takes its steps, what mean optical depth
// each has, and which texel shows what stands there (docs/far-field.md). The far pass and texgen's
// calibration call the same functions; each brings its own way to read a texel.
//
// A path is followed at rest: what the wind has moved (B3) is moved back, so that textures, mean
// areas and heights are those of the set as it was baked, and a ray is a curve among them.
#ifndef SWARD_SHARED_MARCH_H
#define SWARD_SHARED_MARCH_H
#include "shared/march_medium.h"
#include "shared/types.h"

// In GLSL the medium is a uniform block of this name that stands before this header: a copy a call
// would be slow.
#ifdef __cplusplus
#define MARCH_MEDIUM const MarchMedium &medium,
#define MARCH_WITH medium,
#else
#define MARCH_MEDIUM
#define MARCH_WITH
#endif

SHARED_BEGIN

SHARED_CONST int kMarchSteps = 128;   // at most; a canopy that is not opaque by then is cut there
SHARED_CONST float kMarchEnd = 0.02f; // light that is left when a march ends early
SHARED_CONST float kMarchCut =
    0.999f; // share of what is seen that the columns' steps divide; the last takes the rest

// A ray over its ground. s is metres along it from where it begins.
struct MarchPath {
    vec3 from;   // place where it begins: x, z of the world, height over the ground (m)
    vec3 way;    // unit
    vec4 height; // over the ground at s: x + y s + z s^2 (m); w: greatest s
    vec4 bend; // where the wind bends what stands here: unit x, z; curvature (1/m, B3's k); height
               // of the bent canopy (m)
};

SHARED_FN float march_height(MarchPath path, float s) {
    return path.height.x + s * (path.height.y + s * path.height.z);
}

// Sine and cosine of B3's angle, which ends at 90 degrees; within 0.001 there. A march takes dozens
// of them.
SHARED_FN vec2 march_turn(float angle) {
    float x = angle * angle;
    return vec2(angle * (1.0f - x * (1.0f / 6.0f - x * (1.0f / 120.0f - x / 5040.0f))),
                1.0f - x * (0.5f - x * (1.0f / 24.0f - x / 720.0f)));
}

// B3: height over the ground of what stands at height y at rest, and back.
SHARED_FN float march_bent_height(MarchPath path, float y) {
    float x = path.bend.z * y;
    x = x * x;
    return y * (1.0f - x * (1.0f / 6.0f - x * (1.0f / 120.0f - x / 5040.0f)));
}
SHARED_FN float march_rest_height(MarchPath path, float y) {
    float k = path.bend.z;
    float x = k * y;
    float rest = y * (1.0f + x * x * (1.0f / 6.0f + 0.075f * x * x));
    for (int i = 0; i < 2; ++i) { // Newton
        rest += (y - march_bent_height(path, rest)) / max(march_turn(k * rest).y, 0.1f);
    }
    return rest;
}

// Where the point at s stands at rest: x, height over the ground, z.
SHARED_FN vec3 march_rest(MarchPath path, float s) {
    float y = march_rest_height(path, clamp(march_height(path, s), 0.0f, path.bend.w));
    float x = path.bend.z * y;
    float aside = y * x * (0.5f - x * x * (1.0f / 24.0f - x * x / 720.0f)); // (1 - cos k y) / k
    return vec3(path.from.x + path.way.x * s - path.bend.x * aside, y,
                path.from.z + path.way.z * s - path.bend.y * aside);
}

// Motion among the resting blades for a metre of the ray, where its height at rest is y.
SHARED_FN vec3 march_velocity(MarchPath path, float y, float s) {
    vec2 turn = march_turn(path.bend.z * y);
    float upright = max(turn.y, 0.05f);
    float aside = turn.x / upright * (path.height.y + 2.0f * path.height.z * s);
    return vec3(path.way.x - path.bend.x * aside, path.way.y / upright,
                path.way.z - path.bend.y * aside);
}

// Mean area of blades a metre of height in layer i, projected along the axes.
SHARED_FN vec3 march_areas(MARCH_MEDIUM int i) {
    vec4 low = medium.edges[i];
    vec4 high = medium.edges[i + 1];
    return vec3(low.x - high.x, low.y - high.y, low.z - high.z) / max(high.w - low.w, 1e-6f);
}

// Mean optical depth of a metre along `velocity`: the norm of the three projections, as for SGGX
// (Heitz 2015); their sum, right for voxels, is a third too much for blades.
SHARED_FN float march_extinction(vec3 areas, vec3 velocity) {
    return length(areas * velocity);
}

// A place on a path.
struct MarchWalk {
    float s;
    int layer;  // that it is in; -1: on the ground; kMarchLayers: out through the top
    int rising; // 1 once the ray gains height over the ground
    float left; // of the light, in the mean field: what the columns' steps are measured by
};

SHARED_FN MarchWalk march_begin(MarchPath path) {
    MarchWalk walk;
    walk.s = 0.0f;
    walk.left = 1.0f;
    walk.rising = path.height.y > 0.0f ? 1 : 0;
    walk.layer = kMarchLayers - 1;
    return walk;
}

// The same where the path begins below the canopy's top.
SHARED_FN MarchWalk march_begin_inside(MARCH_MEDIUM MarchPath path) {
    MarchWalk walk = march_begin(path);
    float y = march_rest_height(path, min(path.height.x, path.bend.w));
    for (int i = kMarchLayers - 1; i > 0; --i) {
        walk.layer = y < medium.edges[i].w ? i - 1 : walk.layer;
    }
    return walk;
}

SHARED_FN bool march_inside(MarchPath path, MarchWalk walk) {
    return walk.layer >= 0 && walk.layer < kMarchLayers && walk.s < path.height.w;
}

// s at which the path leaves the layer that it is in, through which edge (0 lower, 1 upper).
SHARED_FN float march_layer_end(MARCH_MEDIUM MarchPath path, MarchWalk walk,
                                SHARED_OUT(int) upper) {
    float a = path.height.y;
    float b = path.height.z;
    upper = walk.rising;
    if (walk.rising == 0) {
        float drop = path.height.x - march_bent_height(path, medium.edges[walk.layer].w);
        float square = a * a - 4.0f * b * drop;
        if (square >= 0.0f) {
            return max(2.0f * drop / max(-a + sqrt(square), 1e-9f), walk.s);
        }
        upper = 1; // the ray turns before the lower edge
    }
    float climb = march_bent_height(path, medium.edges[walk.layer + 1].w) - path.height.x;
    float root = sqrt(max(a * a + 4.0f * b * climb, 0.0f));
    float end = a > 0.0f ? 2.0f * climb / (a + root) : (-a + root) / max(2.0f * b, 1e-9f);
    return max(end, walk.s);
}

// Goes on to s_stop, or until the mean optical depth (times `scale`) of this stretch is depth_stop;
// returns that depth.
SHARED_FN float march_advance(MARCH_MEDIUM MarchPath path, SHARED_INOUT(MarchWalk) walk,
                              vec3 s_stop_depth_stop_scale) {
    float passed = 0.0f;
    for (int i = 0; i < 2 * kMarchLayers; ++i) {
        if (!march_inside(path, walk)) {
            break;
        }
        int upper;
        float end = min(march_layer_end(MARCH_WITH path, walk, upper), path.height.w);
        float y = 0.5f * (medium.edges[walk.layer].w + medium.edges[walk.layer + 1].w);
        vec3 velocity = march_velocity(path, y, walk.s);
        float rate = s_stop_depth_stop_scale.z *
                     march_extinction(march_areas(MARCH_WITH walk.layer), velocity);
        float reach = min(s_stop_depth_stop_scale.x,
                          walk.s + (s_stop_depth_stop_scale.y - passed) / max(rate, 1e-9f));
        if (reach < end) {
            passed += rate * max(reach - walk.s, 0.0f);
            walk.s = max(reach, walk.s);
            break;
        }
        passed += rate * (end - walk.s);
        walk.s = end;
        if (end < path.height.w) {
            walk.rising = upper;
            walk.layer += upper == 1 ? 1 : -1;
        }
    }
    return passed;
}

// How a ray is marched.
struct MarchPlan {
    int kind;        // 0 to 2: slabs; kMarchColumns
    int axis;        // that the slabs are across
    int steps;       // of the columns
    float density;   // of the grass here
    float seen;      // opacity of the canopy along the ray, before the correction
    float mip;       // of the slabs; of the columns' footprint alone
    float footprint; // width of the pixel where the ray meets half of what it sees (m)
    float tap;       // length of the ray that it stands for (m)
    float stretch;   // the same over the ground (m)
    float run;       // length of the ray between 5 and 75 percent of what it sees (m)
    float elevation; // of the ray among the resting blades, over the ground's plane (degrees)
    vec2 level;      // its direction over the ground, for a metre of the ray
    vec2 table;      // place in the correction table: half mips, elevation in steps of 5 degrees
};

// Footprints are over the patch's side, so that a lawn and a reed bed are marched alike.
SHARED_CONST float kColumnFrom = 0.055f,
                   kColumnTo = 0.065f;                   // footprint at which the columns take over
SHARED_CONST float kSteepFrom = 70.0f, kSteepTo = 77.0f; // elevation likewise, degrees
SHARED_CONST float kSlabBias = -0.57f,
                   kSlabSoftness =
                       0.95f; // of the slabs' mip: sharper; never below so much of a texel
SHARED_CONST float kSharpTo = 0.012f,
                   kPlainFrom = 0.032f; // footprint to which it is so sharp; from which a pixel is
                                        // its own width: heads sparkle else
SHARED_CONST float kPlainTo = 35.0f,
                   kSharpFrom =
                       55.0f; // elevation, degrees: steeper rays blur slabs enough by crossing them
SHARED_CONST float kColumnBias = -0.85f;
SHARED_CONST float kStepBlur = 0.5f,
                   kTapBlur = 1.5f; // of a step's own length, of its share of a stretched footprint

// Mips of the finest texel that a width (m) is.
SHARED_FN float march_mip(float width, float side) {
    return log(max(width * float(kMarchTexels) / side, 1e-6f)) * 1.442695f;
}

// Width of what a pixel reads of a slab or a column (m), for a footprint `p` on a patch of this
// side; elevation in degrees.
SHARED_FN float march_width(int kind, float p, float side, float elevation) {
    float plain = smoothstep(kSharpTo, kPlainFrom, p / side) *
                  (1.0f - smoothstep(kPlainTo, kSharpFrom, elevation));
    return p * exp2((kind == kMarchColumns ? kColumnBias : kSlabBias) * (1.0f - plain));
}

// Share of the optical depth that the march takes where the near tier draws the share `near` of the
// blades. More than the rest: texels hold all blades, and what they show of a drawn one lies in
// part behind it. Without it grass is 2.6 points thinner from 5 m above, at the band's end.
SHARED_CONST float kHiddenOwn = 0.15f;
SHARED_FN float march_share(float near) {
    return (1.0f - near) / (1.0f - kHiddenOwn * near);
}

// s at which a path has come down to a height at rest, or as far down as it comes.
SHARED_FN float march_reach(MarchPath path, float y) {
    float drop = max(path.height.x - march_bent_height(path, y), 0.0f);
    float a = min(path.height.y, -0.01f);
    float square = max(a * a - 4.0f * path.height.z * drop, 0.0f);
    return min(2.0f * drop / (-a + sqrt(square)), path.height.w);
}

// What a pixel sees of the canopy. `pixel`: width of a pixel at distance 1; `before`: distance from
// the eye to where the path begins.
SHARED_FN MarchPlan march_look(MARCH_MEDIUM MarchPath path, vec3 pixel_before_density) {
    MarchPlan plan;
    plan.density = max(pixel_before_density.z, 1e-3f);
    vec3 velocity = march_velocity(path, 0.6f * medium.canopy_m, 0.0f);
    plan.level = vec2(velocity.x, velocity.z);
    // Over the ground, which may slope: images and tables lie in its plane. Blades do not: what
    // they cover is by the ray's own way.
    float fall =
        abs(path.height.y) / max(march_turn(path.bend.z * 0.6f * medium.canopy_m).y, 0.05f);
    plan.elevation = atan(fall / max(length(plan.level), 1e-4f)) * (180.0f / kPi);
    float at = plan.elevation / 5.0f;
    int row = clamp(int(at), 0, kMarchElevations - 2);
    vec4 view = mix(medium.views[row], medium.views[row + 1], at - float(row));
    plan.seen =
        1.0f - exp(-clamp(plan.density * view.w / max(-path.height.y, 0.02f), 1e-4f, 20.0f));
    float half_way = march_reach(path, view.y);
    plan.footprint = max((pixel_before_density.y + half_way) * pixel_before_density.x, 1e-5f);
    plan.tap = plan.footprint / max(fall, 0.02f);
    plan.stretch = plan.tap * length(plan.level);
    plan.run = march_reach(path, view.z) - march_reach(path, view.x);
    plan.kind = kMarchColumns;
    plan.axis = 0;
    plan.steps = 0;
    plan.mip = 0.0f;
    plan.table = vec2(0.0f, 0.0f);
    return plan;
}

#ifdef __cplusplus
// Fills MarchMedium::views from its edges.
inline void fill_views(MarchMedium& medium) {
    for (int i = 0; i < kMarchElevations; ++i) {
        float elevation = max(5.0f * float(i), 1.0f) * (kPi / 180.0f);
        MarchPath path;
        path.way =
            vec3(cos(elevation) * 0.70710678f, -sin(elevation), cos(elevation) * 0.70710678f);
        path.from = vec3(0.0f, medium.canopy_m, 0.0f);
        path.height = vec4(medium.canopy_m, path.way.y, 0.0f, -medium.canopy_m / path.way.y);
        path.bend = vec4(1.0f, 0.0f, 0.0f, medium.canopy_m);
        MarchWalk whole = march_begin(path);
        float depth = march_advance(medium, path, whole, vec3(1e9f, 1e9f, 1.0f));
        float seen = 1.0f - exp(-min(depth, 20.0f));
        vec4 view(0.0f, 0.0f, 0.0f, depth * sin(elevation));
        for (int part = 0; part < 3; ++part) {
            const float shares[3] = {0.05f, 0.5f, 0.75f};
            MarchWalk walk = march_begin(path);
            march_advance(medium, path, walk, vec3(1e9f, -log(1.0f - shares[part] * seen), 1.0f));
            view[part] = max(march_height(path, walk.s), 0.0f);
        }
        medium.views[i] = view;
    }
}
#endif

// Which kind a pixel is marched by: columns where they do as well, else slabs across the axis that
// the ray runs along most, as thick as the pixel allows and never so thick that few cross the ray.
// Where two are as good, `dither` in (0, 1) decides.
SHARED_FN void march_choose(MARCH_MEDIUM SHARED_INOUT(MarchPlan) plan, float dither) {
    float level = max(length(plan.level), 1e-4f);
    plan.axis = (abs(plan.level.x) - abs(plan.level.y)) / level > 0.04f * (0.5f - dither) ? 0 : 1;
    float columns = max(smoothstep(kSteepFrom, kSteepTo, plan.elevation),
                        smoothstep(kColumnFrom, kColumnTo, plan.footprint / medium.side_m));
    if (columns > dither) {
        plan.kind = kMarchColumns;
        return;
    }
    float angle = plan.elevation * (kPi / 180.0f);
    float steepness = max(sin(angle) / max(cos(angle), 1e-3f), 1e-3f);
    float gap = min(4.5f * plan.footprint, 0.25f * medium.canopy_m / steepness);
    float set = clamp(march_mip(gap, medium.side_m) - 4.0f, 0.0f,
                      2.0f); // 2^4 texels: a slab of the finest set
    float whole = min(floor(set), 1.0f);
    plan.kind = int(whole) + (smoothstep(0.44f, 0.56f, set - whole) > dither ? 1 : 0);
}

// Mips, steps and place in the correction table of a plan whose kind is chosen.
SHARED_FN void march_settle(MARCH_MEDIUM SHARED_INOUT(MarchPlan) plan) {
    float side = medium.side_m;
    float p = plan.footprint;
    if (plan.kind == kMarchColumns) {
        int least = p < 0.15f * side ? 12 : 8;
        plan.steps =
            clamp(int(ceil(plan.run / (2.0f * max(p, side / float(kMarchTexels))))), least, 24);
        plan.mip = march_mip(march_width(plan.kind, p, side, plan.elevation), side);
    } else {
        float own = march_width(plan.kind, p, side, plan.elevation) * float(kMarchTexels) / side;
        plan.mip = max(0.5f * log(own * own + kSlabSoftness * kSlabSoftness) * 1.442695f, 0.0f);
    }
    plan.table = vec2(clamp(2.0f * plan.mip, 0.0f, float(kMarchMips - 1)), plan.elevation / 5.0f);
}

// A step: a stretch of the path and the texel that stands for it.
struct MarchStep {
    vec2 span;   // s from, to
    float depth; // mean optical depth, before the texel's own density and the correction
    vec3 rest;   // where the texel is read: x, height over the ground, z
    float mip;   // counted from the finest texel
    int layer;   // of the columns
};

// Step `number` of the columns: as much of the mean field as takes one of plan.steps equal parts of
// what is seen, and no more than one layer: an image that stood for its neighbours would show its
// own heads for theirs. `scale`: density times the correction.
SHARED_FN MarchStep march_column(MARCH_MEDIUM MarchPath path, MarchPlan plan,
                                 SHARED_INOUT(MarchWalk) walk, vec2 number_scale) {
    float n = float(plan.steps);
    float whole = min(1.0f - exp(number_scale.y / plan.density * log(max(1.0f - plan.seen, 1e-8f))),
                      kMarchCut);
    float after = walk.left - whole / n;
    float most = after > 1.0f - whole + 0.5f * whole / n ? log(walk.left / after) : 1e9f;
    MarchStep taken;
    float from = walk.s;
    taken.layer = clamp(walk.layer, 0, kMarchLayers - 1);
    int upper;
    float end = march_layer_end(MARCH_WITH path, walk, upper);
    float passed = march_advance(MARCH_WITH path, walk, vec3(end, most, number_scale.y));
    walk.left = walk.left * exp(-passed);
    taken.depth = passed / max(number_scale.y, 1e-6f);
    taken.span = vec2(from, walk.s);
    taken.rest = march_rest(path, 0.5f * (from + walk.s));
    // Steps are the taps of a footprint that is stretched along the ray, too: each a golden ratio
    // further.
    float tap = (fract(number_scale.x * 0.61803399f) - 0.5f) * plan.tap;
    taken.rest.x += path.way.x * tap;
    taken.rest.z += path.way.z * tap;
    float own = kStepBlur * (walk.s - from) * length(vec2(path.way.x, path.way.z));
    taken.mip = max(plan.mip, march_mip(max(own, kTapBlur * plan.stretch / n), medium.side_m));
    return taken;
}

// s of the next plane between slabs, and never so near that a step is nothing.
SHARED_FN float march_next_plane(MARCH_MEDIUM MarchPath path, MarchPlan plan, float s) {
    float gap = medium.side_m / float(kFinestSlabs >> plan.kind);
    vec3 rest = march_rest(path, s);
    vec3 velocity = march_velocity(path, rest.y, s);
    float along = plan.axis == 0 ? velocity.x : velocity.z;
    float at = (plan.axis == 0 ? rest.x : rest.z) / gap;
    float speed = max(abs(along), 0.05f) / gap;
    float left = along > 0.0f ? floor(at) + 1.0f - at : at - (ceil(at) - 1.0f);
    left = left < 0.05f ? left + 1.0f : left;
    return s + left / speed;
}

// The next step from plane to plane. The first goes on to the slab where one percent of the light
// is gone.
SHARED_FN MarchStep march_slab(MARCH_MEDIUM MarchPath path, MarchPlan plan,
                               SHARED_INOUT(MarchWalk) walk, vec2 number_scale) {
    MarchStep taken;
    float from = walk.s;
    taken.depth = 0.0f;
    if (number_scale.x < 0.5f) {
        taken.depth = march_advance(MARCH_WITH path, walk, vec3(1e9f, 0.01f, number_scale.y));
    }
    float begin = walk.s;
    float stop = march_next_plane(MARCH_WITH path, plan, begin);
    taken.depth += march_advance(MARCH_WITH path, walk, vec3(stop, 1e9f, number_scale.y));
    taken.depth /= max(number_scale.y, 1e-6f);
    taken.span = vec2(from, walk.s);
    taken.rest = march_rest(path, 0.5f * (begin + walk.s));
    taken.mip = plan.mip;
    taken.layer = clamp(walk.layer, 0, kMarchLayers - 1);
    return taken;
}

SHARED_FN MarchStep march_step(MARCH_MEDIUM MarchPath path, MarchPlan plan,
                               SHARED_INOUT(MarchWalk) walk, vec2 number_scale) {
    if (plan.kind == kMarchColumns) {
        return march_column(MARCH_WITH path, plan, walk, number_scale);
    }
    return march_slab(MARCH_WITH path, plan, walk, number_scale);
}

// Where a step's texel is: u, v in its image, number of the image in the array. `place`: of
// taken.rest in patch sides, its tile's variant.
SHARED_FN vec3 march_texel(MARCH_MEDIUM MarchPlan plan, MarchStep taken, vec3 place_variant) {
    if (plan.kind == kMarchColumns) {
        return vec3(place_variant.x, place_variant.y,
                    place_variant.z * float(kMarchLayers) + float(taken.layer));
    }
    int count = kFinestSlabs >> plan.kind;
    float across = plan.axis == 0 ? place_variant.x : place_variant.y;
    int slab = clamp(int(floor(fract(across) * float(count))), 0, count - 1);
    float along = plan.axis == 0 ? place_variant.y : place_variant.x;
    return vec3(along, taken.rest.y / medium.canopy_m,
                float((int(place_variant.z) * 2 + plan.axis) * count + slab));
}

// Optical depth of blades whose area along a step is `area` times the way. In the thickness of a
// step blades stand beside rather than behind each other: what n of them cover adds up. Wholly
// beside, depth is -log(1 - area) = area + area^2 / 2 + ..; the factor is what pictures need, whose
// texels blur what stands beside: without it a flower's head lets a third of the light through, and
// contrast is 0.75 of the truth's 20 m below the eye.
SHARED_CONST float kSideBySide = 1.2f;
SHARED_FN float march_beside(float area) {
    return area * (1.0f + kSideBySide * area);
}

// Finest mip of a kind's textures, in mips of the finest texel.
SHARED_FN float march_base(int kind) {
    return kind == kMarchColumns ? float(kColumnBase) : float(kind);
}

SHARED_END
#endif
