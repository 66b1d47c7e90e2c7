// SPDX-License-Identifier: Apache-2.0
#include "terrain/frustum.h"

namespace sward::terrain {

Frustum::Frustum(const glm::mat4& m) {
    const glm::mat4 rows = glm::transpose(m);
    planes_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3]};
}

bool Frustum::may_see(glm::vec3 low, glm::vec3 high) const {
    for (const glm::vec4& plane : planes_) {
        const glm::vec3 n(plane);
        const glm::vec3 farthest(n.x > 0 ? high.x : low.x, n.y > 0 ? high.y : low.y,
                                 n.z > 0 ? high.z : low.z);
        if (glm::dot(n, farthest) + plane.w < 0) {
            return false;
        }
    }
    return true;
}

} // namespace sward::terrain
