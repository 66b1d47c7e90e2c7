// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/angles.h"

namespace sward::app {

struct Angles {
    double yaw = 0, pitch = 0, roll = 0; // degrees
};

/// Of a frame (x right, y up, z behind), as camera_of() turns.
[[nodiscard]] inline Angles angles_of(const glm::dquat& turn) {
    const glm::dvec3 ahead = turn * glm::dvec3(0, 0, -1), right = turn * glm::dvec3(1, 0, 0),
                     up = turn * glm::dvec3(0, 1, 0);
    return {std::atan2(ahead.x, -ahead.z) / base::kDegree,
            std::asin(std::clamp(ahead.y, -1.0, 1.0)) / base::kDegree,
            std::atan2(-right.y, up.y) / base::kDegree};
}

} // namespace sward::app
