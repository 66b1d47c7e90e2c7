// SPDX-License-Identifier: Apache-2.0
// In: what lies pressed. Out: the same in units of the next epoch (C6 and what lasts).
#include "tracks/cells.glsl"

uniform float factor;

void main() {
    int own = cell_index(pages[gl_WorkGroupID.z].slot.x, ivec2(gl_GlobalInvocationID.xy));
    pressed[own] *= factor;
}
