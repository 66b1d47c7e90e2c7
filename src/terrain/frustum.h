// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace sward::terrain {

/// View volume in anchor-relative metres: four sides and the plane of the eye (reversed depth has
/// no far plane).
class Frustum {
public:
    explicit Frustum(const glm::mat4& clip_from_world);
    /// False only when the box is surely outside.
    [[nodiscard]] bool may_see(glm::vec3 low, glm::vec3 high) const;

private:
    std::array<glm::vec4, 5> planes_;
};

} // namespace sward::terrain
