// SPDX-License-Identifier: Apache-2.0
#include "app/pilot_seat.h"

#include <algorithm>
#include <cmath>

#include "app/controls.h"
#include "app/turn_angles.h"

namespace sward::app {
namespace {

constexpr double kKeyThrow = 0.45; // of the whole: keys know no half

} // namespace

void PilotSeat::begin(double yaw_deg, double lever) {
    stick_ = {0, 0, 0};
    lever_ = lever;
    eye_.begin(yaw_deg);
}

void PilotSeat::take(const PoseMoment& moment) {
    const Input& asked = moment.input;
    for (const Press& press : asked.presses) {
        if (press.action == Action::kDriveCamera) {
            behind_ = !behind_;
            eye_.look_ahead();
        } else if (press.action == Action::kMoreThrottle) {
            lever_ += feel_.lever_step;
        } else if (press.action == Action::kLessThrottle) {
            lever_ -= feel_.lever_step;
        }
    }
    lever_ = std::clamp(lever_ + feel_.lever_step * asked.wheel, 0.0, 1.0);
    // Keys move the stick some way, and it goes there in a moment.
    const glm::dvec3 wanted = glm::dvec3(asked.move.x, -asked.move.z, asked.move.y) * kKeyThrow;
    stick_ += (wanted - stick_) * (1 - std::exp(-feel_.key_follow_per_s * moment.dt_s));
    eye_.look_aside(asked.look_px);
}

glm::dvec3 PilotSeat::stick(const Input& input) const {
    using input::Axis;
    const glm::dvec3 device(input.axis(Axis::kRoll), input.axis(Axis::kPitch),
                            input.axis(Axis::kYaw));
    return glm::clamp(stick_ + device, -1.0, 1.0);
}

double PilotSeat::lever(const Input& input) const {
    return std::clamp(lever_ + input.axis(input::Axis::kThrottle), 0.0, 1.0);
}

void PilotSeat::place_eye(ViewPose& view, const PoseMoment& moment, const Place& place) {
    const Angles sight = angles_of(place.turn);
    if (behind_) {
        eye_.come_round(sight.yaw, feel_.chase, moment.dt_s);
        eye_.put_behind(view, place.position, feel_.chase, moment.land);
    } else {
        eye_.put_on_board(view, place.position + place.turn * place.eye_m, sight, moment.land);
    }
}

} // namespace sward::app
