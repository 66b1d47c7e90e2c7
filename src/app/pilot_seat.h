// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "app/model_eye.h"
#include "app/pose_source.h"

namespace sward::app {

/// What the pilots of an aeroplane and of a helicopter have alike: a stick and a lever, which keys
/// and devices move, and an eye on board or behind.
class PilotSeat {
public:
    struct Feel {
        double lever_step;       ///< for a key or a notch of the mouse's wheel; of the whole
        double key_follow_per_s; ///< how fast the stick goes where a key sends it
        ModelEye::Chase chase;   ///< of the eye behind
    };
    /// Where the aircraft is.
    struct Place {
        glm::dvec3 position;
        glm::dquat turn;
        glm::dvec3 eye_m; ///< on board
    };

    explicit PilotSeat(const Feel& feel) : feel_(feel) {}
    void begin(double yaw_deg, double lever);
    /// The camera's key, the lever's keys and wheel, and the stick's keys for a moment's time.
    void take(const PoseMoment& moment);
    /// Roll, pitch, yaw, each from -1 to 1: keys and devices together.
    [[nodiscard]] glm::dvec3 stick(const Input& input) const;
    /// The throttle, or the collective: 0 to 1; a device's on top of the keys'.
    [[nodiscard]] double lever(const Input& input) const;
    [[nodiscard]] double lever() const { return lever_; }
    void place_eye(ViewPose& view, const PoseMoment& moment, const Place& place);

private:
    Feel feel_;
    ModelEye eye_;
    bool behind_ = false;
    glm::dvec3 stick_{0}; ///< as the keys have it: roll, pitch, yaw
    double lever_ = 0;
};

} // namespace sward::app
