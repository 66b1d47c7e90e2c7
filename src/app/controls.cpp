// SPDX-License-Identifier: Apache-2.0
#include "app/controls.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "base/angles.h"

namespace sward::app {
namespace {

constexpr double kLeastSpeed = 0.2, kMostSpeed = 1000; // m/s: a beetle, a fast jet
constexpr double kWheelFactor = 1.2;                   // a notch
constexpr double kFastFactor = 8;                      // shift
constexpr double kMouseDegrees = 0.12;                 // a pixel
constexpr double kStickDegrees = 90;                   // a second, stick at its end
constexpr double kSteepest = 89.9;     // degrees: yaw means nothing straight up or down
constexpr double kEyeClearance = 0.15; // m: nearer, the near plane cuts the ground
constexpr double kLongestStep = 0.25;  // s: a stopped process that continues must not leap

} // namespace

void FlyControls::step(scene::Pose& pose, const Input& input, double dt_s) {
    const double dt = std::isfinite(dt_s) ? std::clamp(dt_s, 0.0, kLongestStep) : 0.0;
    speed_mps_ =
        std::clamp(speed_mps_ * std::pow(kWheelFactor, std::clamp(input.wheel, -20.0, 20.0)),
                   kLeastSpeed, kMostSpeed);
    const double turn = kStickDegrees * dt;
    const double yaw = pose.yaw_deg + input.look_px.x * kMouseDegrees + input.look_rate.x * turn;
    const double pitch =
        pose.pitch_deg - input.look_px.y * kMouseDegrees + input.look_rate.y * turn;
    pose.yaw_deg = yaw - 360 * std::floor(yaw / 360);
    pose.pitch_deg = std::clamp(pitch, -kSteepest, kSteepest);

    const glm::dvec2 aside = base::Heading(pose.yaw_deg).right();
    const glm::dvec3 right{aside.x, 0, aside.y};
    const glm::dvec3 forward = base::direction_of(pose.yaw_deg, pose.pitch_deg);
    const glm::dvec3 way =
        right * input.move.x + glm::dvec3(0, 1, 0) * input.move.y + forward * input.move.z;
    pose.position += way * (speed_mps_ * (input.fast ? kFastFactor : 1) * dt);
}

void keep_above_ground(scene::Pose& pose, double ground_m) {
    pose.position.y = std::max(pose.position.y, ground_m + kEyeClearance);
}

} // namespace sward::app
