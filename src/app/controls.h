// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/window.h"
#include "scene/scene.h"

namespace sward::app {

/// Flying: along the view with W and S, sideways with A and D, straight up and down with E and Q.
class FlyControls {
public:
    /// Moves `pose` (above the datum) by what the input asks for in `dt_s` seconds.
    void step(scene::Pose& pose, const Input& input, double dt_s);
    [[nodiscard]] double speed_mps() const { return speed_mps_; }

private:
    double speed_mps_ = 5;
};

/// Lifts a pose that would be in the ground to the least height of an eye above it.
void keep_above_ground(scene::Pose& pose, double ground_m);

} // namespace sward::app
