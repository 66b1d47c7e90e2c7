// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/flow_overlay.h"
#include "app/turn_angles.h"
#include "app/view_pose.h"

namespace sward::app {

/// The eye of who drives or flies: on board, or behind what moves, where it comes round slowly; the
/// mouse turns it aside.
class ModelEye {
public:
    /// How it follows from behind.
    struct Chase {
        double back_m, up_m;
        double per_s; ///< how fast it comes round
        double pitch_deg;
    };

    void begin(double yaw_deg) { chase_yaw_ = yaw_deg; }
    void look_ahead() { look_ = {0, 0}; }
    void look_aside(glm::dvec2 mouse_px);
    void put_on_board(ViewPose& view, const glm::dvec3& at, const Angles& sight,
                      const Land& land) const;
    /// Turns towards where the model points, `yaw_deg`, as far as it comes in `dt_s` seconds.
    void come_round(double yaw_deg, const Chase& chase, double dt_s);
    void put_behind(ViewPose& view, const glm::dvec3& model, const Chase& chase,
                    const Land& land) const;

private:
    glm::dvec2 look_{0, 0}; ///< degrees
    double chase_yaw_ = 0;
};

} // namespace sward::app
