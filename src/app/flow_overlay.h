// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "app/eye.h"

namespace sward::app {

/// What the overlays ask of the world; world metres.
struct Land {
    std::function<double(double x, double z)> height;   ///< of the ground above the datum
    std::function<glm::dvec2(double x, double z)> wind; ///< m/s, east and south, now
};

/// Streaks along the wind just above the ground, coloured by speed, with their scale in a corner.
/// Within an ImGui frame.
void draw_flow(const Eye& eye, const Land& land, double time_s);

} // namespace sward::app
