// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

#include "app/keys.h"
#include "input/control_map.h"

namespace sward::app {

/// What keyboard, mouse and devices ask for in one frame.
struct Input {
    glm::dvec3 move{0, 0, 0};   ///< right, up, forward: -1..1 each
    glm::dvec2 look_px{0, 0};   ///< mouse, right and down, while its right button is held
    glm::dvec2 look_rate{0, 0}; ///< sticks: right and up, -1..1
    double wheel = 0;           ///< of the mouse, notches, up positive
    bool fast = false;
    bool hand_brake = false;                 ///< a button that is held
    std::array<double, input::kAxes> axes{}; ///< of the devices that controls.toml binds
    std::vector<Press> presses;              ///< in their order

    [[nodiscard]] double axis(input::Axis which) const {
        return axes[static_cast<std::size_t>(which)];
    }
    [[nodiscard]] bool has(Action action) const {
        return std::any_of(presses.begin(), presses.end(),
                           [&](const Press& press) { return press.action == action; });
    }
};

} // namespace sward::app
