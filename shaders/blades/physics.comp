// SPDX-License-Identifier: Apache-2.0
// In: patches that are awake, the wind, their colliders. Out: their blades' states one step on (J4 to J6), and which patches have
// come to rest. The twin is blades::step_blade.
#include "blades/physics.glsl"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_PHYSICS_STATES) buffer States { vec4 states[]; };
layout(std430, binding = BIND_PHYSICS_AWAKE) readonly buffer Awake { uint awake[]; };
layout(std430, binding = BIND_PHYSICS_SPHERES) readonly buffer Spheres { vec4 spheres[]; }; // now, radius; before

shared uint moving;
shared vec2 patch_wind;

// Number in the list of the next sphere that could touch the blade, from `n` on; the list's end: none. A loop of its own, so that lanes
// whose blades are free do not wait for each other's spheres.
uint next_near(vec3 root, uvec2 list, uint n, vec3 v1, vec3 v2) {
    while (n < list.y) {
        uint sphere = 2u * sphere_lists[list.x + n];
        vec4 now = spheres[sphere];
        if (sphere_is_near(v1, v2, vec4(now.xyz - root, now.w), spheres[sphere + 1u].xyz - root)) {
            break;
        }
        ++n;
    }
    return n;
}

void collide(BladeBody body, vec3 root, uvec2 list, inout vec3 v1, inout vec3 v2) {
    for (int round = 0; round < kCollisionRounds; ++round) {
        bool touched = false;
        for (uint n = next_near(root, list, 0u, v1, v2); n < list.y; n = next_near(root, list, n + 1u, v1, v2)) {
            uint sphere = 2u * sphere_lists[list.x + n];
            vec4 now = spheres[sphere];
            touched = collide_blade(body, v1, v2, vec4(now.xyz - root, now.w), spheres[sphere + 1u].xyz - root) || touched;
        }
        if (!touched) {
            return;
        }
    }
}

// Steps the blade; true while it moves or remembers.
bool step_blade(PhysicsRecord blade, vec3 root, vec2 wind, uvec2 list, uint at) {
    BladeBody body = physics_body(blade, root);
    vec4 state = states[at];
    if (!blade_moves(body)) {
        states[at] = vec4(0.0);
        return false;
    }
    vec3 v2 = state_tip(body, state);
    float eta = state.w;
    vec3 v1 = move_blade(rules, body, checked_wind(vec3(wind.x, 0.0, wind.y)), v2, eta);
    vec3 moved = v2;
    collide(body, root, list, v1, v2);
    vec4 next = vec4(v2 - body.calm2, remember_push(rules, body, v2 - moved, eta));
    states[at] = next;
    return next.w > 0.0 || distance(next.xyz, state.xyz) > kStillMove * body.stem_canopy.x;
}

void main() {
    uint patch_id = awake[gl_WorkGroupID.x];
    uint lane = gl_LocalInvocationID.x;
    BladePage page = pages[patch_id / uint(patches_a_page)];
    uvec2 list = uvec2(sphere_lists[2u * patch_id], sphere_lists[2u * patch_id + 1u]);
    uint status = patches[patch_id].status;
    uint within = (patch_id % uint(patches_a_page)) * uint(CULL_GROUP) + lane;
    if (lane == 0u) {
        moving = 0u;
    }
    barrier();
    if (within < uint(page.run.y)) {
        PhysicsRecord blade = records[uint(page.run.x) + within];
        vec3 root = physics_root(page, blade, list.y > 0u || rules.memory.w > 0.0);
        vec2 wind = wind_of(step_wind, root.xz);
        uint at = patch_id * uint(CULL_GROUP) + lane;
        bool moves = true;
        if (status == kPatchNew) {
            BladeBody body = physics_body(blade, vec3(0.0));
            states[at] = grouped_state(body, wind, rules.time.z > 0.0 ? rules.time.z : body.response);
        }
        if (status != kPatchNew || (list.y > 0u && rules.time.x > 0.0)) { // in a run-up a collider finds blades that have not begun
            moves = step_blade(blade, root, wind, list, at);
        }
        if (moves) {
            moving = 1u; // by any lane
        }
        if (lane == 0u) {
            patch_wind = wind;
        }
    }
    barrier();
    if (lane == 0u) {
        uint next = moving > 0u || list.y > 0u ? kPatchAwake : kPatchAsleep;
        patches[patch_id] = PatchState(patch_wind, next, status == kPatchNew ? 0u : patches[patch_id].steps + 1u);
    }
}
