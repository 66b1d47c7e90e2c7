// SPDX-License-Identifier: Apache-2.0
// What every surface's fragment shader writes. The AOV targets exist only in the variant that fills
// them.
#include "lib/tiers.glsl"
#include "shared/bindings.h"

layout(location = OUT_COLOR) out vec4 out_color;
#ifdef AOV
layout(location = OUT_DATA) out vec4 out_data;
layout(location = OUT_TANGENT) out vec4 out_tangent;
layout(location = OUT_NORMAL) out vec4 out_normal;
#endif

// tier_coverage_rank: tier, share of the pixel that is grass, rank of the blade.
void write_surface(vec3 radiance, vec3 tier_coverage_rank, vec3 tangent, vec3 normal) {
    out_color = vec4(radiance,
                     tier_coverage_rank.y); // alpha: coverage, averaged by the resolve like colour
#ifdef AOV
    out_data = vec4(tier_coverage_rank, 1.0);
    out_tangent = vec4(tangent, 0.0);
    out_normal = vec4(normal, 0.0);
#endif
}
