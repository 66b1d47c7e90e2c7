// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace sward::wind {

using Paths = std::map<std::string, scene::Path>;

/// Where a source or obstacle is at one time, and how it moves.
struct Carried {
    glm::dvec2 place{0, 0};    ///< world x, z (m)
    double yaw_deg = 0;        ///< 0 looks north, positive to the east
    glm::dvec2 velocity{0, 0}; ///< m/s
    double turn_rad_s = 0;     ///< clockwise from above
    double height_m = 0;       ///< of the path's point, as the path counts it; 0 without a path
    bool agl = true;           ///< height_m is above the ground
};

/// `place.path`, if any, is among `paths`.
[[nodiscard]] Carried carried_at(const scene::WindPlace& place, const Paths& paths, double time_s);

} // namespace sward::wind
