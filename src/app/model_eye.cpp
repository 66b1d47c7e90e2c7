// SPDX-License-Identifier: Apache-2.0
#include "app/model_eye.h"

#include <algorithm>
#include <cmath>

#include "app/controls.h"
#include "base/angles.h"

namespace sward::app {
namespace {

constexpr double kMouseDegrees = 0.12; // a pixel

} // namespace

void ModelEye::look_aside(glm::dvec2 mouse_px) {
    look_ += glm::dvec2(mouse_px.x, -mouse_px.y) * kMouseDegrees;
}

void ModelEye::put_on_board(ViewPose& view, const glm::dvec3& at, const Angles& sight,
                            const Land& land) const {
    view.pose.position = at;
    view.pose.yaw_deg = sight.yaw + look_.x - 360 * std::floor((sight.yaw + look_.x) / 360);
    view.pose.pitch_deg = std::clamp(sight.pitch + look_.y, -89.9, 89.9);
    view.roll_deg = sight.roll;
    keep_above_ground(view.pose, land.height(at.x, at.z));
}

void ModelEye::come_round(double yaw_deg, const Chase& chase, double dt_s) {
    chase_yaw_ += std::remainder(yaw_deg - chase_yaw_, 360.0) * (1 - std::exp(-chase.per_s * dt_s));
}

void ModelEye::put_behind(ViewPose& view, const glm::dvec3& model, const Chase& chase,
                          const Land& land) const {
    const glm::dvec2 back = base::Heading(chase_yaw_ + look_.x).back() * chase.back_m;
    const glm::dvec3 at = model + glm::dvec3(back.x, chase.up_m, back.y);
    put_on_board(view, at, {chase_yaw_, chase.pitch_deg, 0}, land);
}

} // namespace sward::app
