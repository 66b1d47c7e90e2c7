// SPDX-License-Identifier: Apache-2.0
// A blade that stands on any surface (J1's own packing), where it comes to rest (J4, J5) and its
// outline (J8). Placement on the CPU, the cull pass and the tessellator read the same functions.
#ifndef SWARD_SHARED_SURFACE_BLADE_H
#define SWARD_SHARED_SURFACE_BLADE_H
#include "shared/blade_physics.h"
#include "shared/hash.h"

SHARED_BEGIN

// J1, 64 bytes. Metres in the mesh's space; v1 and v2 relative to the root, in the calm: where
// gravity and recovery balance.
struct SurfaceBlade {
    vec4 root_direction; // root; turn of the width direction about `up` (rad), whole turns more by
                         // the number of a set's species
    vec4 v1_height;      // middle control point; length of the blade
    vec4 v2_width;       // tip; half width at its widest
    vec4 up_stiffness; // the surface's unit normal at the root; stiffness: recovery rate, 0 limp ..
                       // 1 stiff
};
#ifdef __cplusplus
static_assert(sizeof(SurfaceBlade) == 64);
#endif

// Unit width direction (J8, t1): `turn` about a unit `up`. For up = +y it is
// blade_width_direction's. The basis about `up` is Duff et al.'s (JCGT 2017), with no place where
// it degenerates.
SHARED_FN vec3 surface_width_direction(vec3 up, float turn) {
    float side = up.y >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (side + up.y);
    float b = up.x * up.z * a;
    vec3 first = vec3(1.0f + side * up.x * up.x * a, -side * up.x, side * b);
    vec3 second = vec3(b, -up.z, side + up.z * up.z * a);
    return cos(turn) * first + sin(turn) * second;
}

// Rank and seed of a blade, each (n + 0.5) / 256: the same choices as of a set's blades hang on
// them.
SHARED_FN vec2 surface_rank_seed(uint index) {
    uint h = hash_pcg(index ^ 0x6e657462u);
    return (vec2(float(h & 255u), float((h >> 8u) & 255u)) + 0.5f) / 256.0f;
}

// A blade in J1's pose, of this length: what J5 needs.
SHARED_FN BladeBody upright_body(vec3 up, float height) {
    BladeBody body;
    body.up = up;
    body.calm1 = up * height;
    body.calm2 = up * height;
    body.gravity = vec3(0.0f, 0.0f, 0.0f);
    body.stem_canopy = vec2(height, height);
    body.recovery = 0.0f;
    body.response = 0.0f;
    return body;
}

// Where J4's recovery and gravity balance, J5 kept: a blade in the calm. `pull`: gravity over
// stiffness (as a shift, m). J1's pose is `height * up`. Eight half steps leave less than 1 % of
// the way.
SHARED_FN void surface_settle(SHARED_OUT(vec3) v1, SHARED_OUT(vec3) v2, vec3 up, float height,
                              vec3 pull) {
    BladeBody body = upright_body(up, height);
    v2 = body.calm2;
    v1 = body.calm1;
    vec3 wanted = body.calm2 + pull;
    for (int i = 0; i < 8; ++i) {
        v2 = v2 + 0.5f * (wanted - v2);
        v1 = settle_blade(body, v2);
    }
}

// A mesh's blade but for its gravity. `canopy`: greatest length of a blade there (m).
SHARED_FN BladeBody surface_blade_shape(SurfaceBlade blade, float canopy) {
    return blade_shape(vec3(blade.up_stiffness.x, blade.up_stiffness.y, blade.up_stiffness.z),
                       vec3(blade.v1_height.x, blade.v1_height.y, blade.v1_height.z),
                       vec3(blade.v2_width.x, blade.v2_width.y, blade.v2_width.z),
                       blade.up_stiffness.w, canopy);
}

// The whole body. Its front is square to its width, as it has grown; the more its calm tip is off
// its root's normal, the more it sags.
SHARED_FN BladeBody surface_blade_body(BladeStep rules, SurfaceBlade blade, vec3 root) {
    BladeBody body = surface_blade_shape(blade, rules.canopy_m);
    vec3 front = cross(body.up, surface_width_direction(body.up, blade.root_direction.w));
    float off = min(
        length(body.calm2 - body.up * body.stem_canopy.x) / max(body.stem_canopy.x, 1e-6f), 1.0f);
    float sag = 0.03f + 0.05f * off; // of its length, as a set's blade by its droop
    body.gravity = blade_gravity(rules, root, front,
                                 body.recovery * body.stem_canopy.x * sag / kStandardGravity);
    return body;
}

// J4's gravity (m): down, and a quarter of it to the front, square to the width.
SHARED_FN vec3 surface_gravity(vec3 up, vec3 width_direction, float strength_m) {
    return strength_m * (vec3(0.0f, -1.0f, 0.0f) + 0.25f * cross(up, width_direction));
}

// J8's shapes.
SHARED_CONST int kShapeQuad = 0;
SHARED_CONST int kShapeTriangle = 1;
SHARED_CONST int kShapeQuadratic = 2;
SHARED_CONST int kShapeTriangleTip = 3;
SHARED_CONST int kShapeDandelion = 4;
SHARED_CONST float kShapeOfSet = -1.0f; // a set's blade: the outline of its species

// Segments along a blade of this shape when it could do with `wanted`, at most `most` (even): an
// even number where an outline has kinks, so that stations meet them. A leaf's is twice the number
// of its teeth, or a multiple: each has its point and its notch. `shape`: kind; v where a
// triangle-tip begins; teeth of a leaf, depth of its notches 0..1.
SHARED_FN float surface_blade_level(float wanted, float most, vec4 shape) {
    int kind = int(shape.x + 0.5f);
    float level = clamp(floor(wanted + 0.5f), kind <= kShapeTriangle ? 1.0f : 2.0f, most);
    if (kind < kShapeTriangleTip) {
        return level;
    }
    float teeth = kind == kShapeDandelion ? shape.z : 1.0f;
    float halves = max(floor(0.5f * level), 1.0f);
    return 2.0f * (halves < teeth ? halves : teeth * floor(halves / teeth));
}

// Teeth that `level` segments can show: as many as the leaf has, or as there are pairs of segments.
SHARED_FN float surface_blade_teeth(vec4 shape, float level) {
    return clamp(floor(0.5f * level), 1.0f, max(shape.z, 1.0f));
}

// Place of a tooth's point between two notches: teeth look back to the root, the fewer they are the
// less.
SHARED_FN float surface_tooth_point(float teeth) {
    return 0.3f + 0.3f / teeth;
}

// v of the mesh's station t in [0, 1]: where its outline has kinks, stations stand on them.
SHARED_FN float surface_blade_station(float t, vec4 shape, float level) {
    int kind = int(shape.x + 0.5f);
    if (kind == kShapeTriangleTip) {
        return t < 0.5f ? 2.0f * t * shape.y : shape.y + (2.0f * t - 1.0f) * (1.0f - shape.y);
    }
    if (kind != kShapeDandelion) {
        return t;
    }
    float teeth = surface_blade_teeth(shape, level);
    float tooth = min(floor(t * teeth + 1e-4f), teeth - 1.0f);
    float phase = clamp(t * teeth - tooth, 0.0f, 1.0f);
    float peak = surface_tooth_point(teeth);
    float warped =
        phase < 0.5f ? 2.0f * phase * peak : peak + (2.0f * phase - 1.0f) * (1.0f - peak);
    return (tooth + warped) / teeth;
}

// Width at v over the greatest. J8's printed forms have the same width; ours stand about the middle
// (the quadratic one, u - u v^2, pins the left rim). The leaf is of our own making: a spoon with a
// row of teeth that look back to the root. Their number follows the level, their depth does not, so
// that the leaf keeps its teeth and its mean width at every level.
SHARED_FN float surface_blade_width(float v, vec4 shape, float level) {
    int kind = int(shape.x + 0.5f);
    if (kind == kShapeQuad) {
        return 1.0f;
    }
    if (kind == kShapeTriangle) {
        return 1.0f - v;
    }
    if (kind == kShapeQuadratic) {
        return 1.0f - v * v;
    }
    if (kind == kShapeTriangleTip) {
        return 1.0f - max(v - shape.y, 0.0f) / max(1.0f - shape.y, 1e-3f);
    }
    float teeth = surface_blade_teeth(shape, level);
    float tooth = min(floor(v * teeth), teeth - 1.0f);
    float phase = v * teeth - tooth;
    float peak = surface_tooth_point(teeth);
    float point = phase < peak ? phase / peak : (1.0f - phase) / (1.0f - peak);
    float v2 = v * v;
    float spoon = 1.3f * (0.22f + 0.98f * v) * (1.0f - v2 * v2 * v2);
    return min(spoon, 1.0f) * (1.0f - shape.w * (1.0f - clamp(point, 0.0f, 1.0f)));
}

// J8's t with the width correction: where u in [0, 1] across lands between the rims. `phi` 1: too
// thin for its outline to show, it stays as wide as at its root. The printed t (1 - phi) + u phi^2
// has weights that do not add to one and drags the blade aside.
SHARED_FN float surface_blade_outline(float u, float v, vec4 shape, vec2 level_phi) {
    float t = 0.5f + (u - 0.5f) * surface_blade_width(v, shape, level_phi.x);
    return mix(t, u, level_phi.y * level_phi.y);
}

SHARED_END
#endif
