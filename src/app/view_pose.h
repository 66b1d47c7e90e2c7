// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "sward/camera.h"

namespace sward::app {

/// Where the picture is seen from. The pose is above the datum.
struct ViewPose {
    scene::Pose pose;
    double roll_deg = 0; ///< positive lowers the right wing
};

/// Its camera for a picture of so many pixels.
[[nodiscard]] inline Camera camera_of(const ViewPose& view, int width, int height) {
    const scene::Pose& at = view.pose;
    return sward::camera_of({at.position, at.yaw_deg, at.pitch_deg, view.roll_deg, at.fov_deg},
                            width, height);
}

} // namespace sward::app
