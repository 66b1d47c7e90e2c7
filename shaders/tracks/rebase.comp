// SPDX-License-Identifier: Apache-2.0
// In: what lies pressed. Out: the same in units of the next epoch (C6 and what lasts).
#include "tracks/cells.glsl"

void main() {
    int own = cell_word(blocks[gl_WorkGroupID.z].slot, ivec2(gl_GlobalInvocationID.xy));
    shown[own] = track_rebased(shown[own]);
}
