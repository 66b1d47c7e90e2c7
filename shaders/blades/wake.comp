// SPDX-License-Identifier: Apache-2.0
// In: all patches. Out: those that have something to do in this step, as the physics pass's indirect dispatch.
#include "blades/physics.glsl"

layout(local_size_x = WAKE_GROUP) in;
layout(std430, binding = BIND_PHYSICS_AWAKE) writeonly buffer Awake { uint awake[]; };
layout(std430, binding = BIND_PHYSICS_DISPATCH) buffer Dispatch {
    uint groups;
    uint groups_y, groups_z;
    uint all_groups; // of all steps since the count began
};
uniform int patch_count;

void main() {
    uint patch_id = gl_GlobalInvocationID.x;
    if (patch_id >= uint(patch_count)) {
        return;
    }
    BladePage page = pages[patch_id / uint(patches_a_page)];
    if (page.run.z != buffer_number) {
        return;
    }
    PatchState state = patches[patch_id];
    bool met = sphere_lists[2u * patch_id + 1u] > 0u;
    bool up = met && state.status != kPatchFree;
    if (state.status == kPatchNew) {
        up = met || rules.time.w == 0.0;
    } else if (rules.time.x == 0.0) {
        up = false;
    } else if (state.status == kPatchAwake) {
        up = true;
    } else if (state.status == kPatchAsleep && !met) {
        vec3 root = physics_root(page, records[page.run.x + int(patch_id % uint(patches_a_page)) * CULL_GROUP], false);
        up = distance(wind_of(step_wind, root.xz), state.wind) > kStillWind_ms;
    }
    if (up) {
        // The order varies from run to run; patches know nothing of each other.
        awake[atomicAdd(groups, 1u)] = patch_id;
        atomicAdd(all_groups, 1u);
    }
}
