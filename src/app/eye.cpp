// SPDX-License-Identifier: Apache-2.0
#include "app/eye.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace sward::app {
namespace {

using base::kDegree;

} // namespace

Eye::Eye(const scene::Pose& pose, glm::dvec2 size) : position_(pose.position), size_(size) {
    ahead_ = base::direction_of(pose.yaw_deg, pose.pitch_deg);
    const glm::dvec2 aside = base::Heading(pose.yaw_deg).right();
    right_ = {aside.x, 0, aside.y};
    up_ = glm::cross(right_, ahead_);
    focal_ = 0.5 * std::max(size.y, 1.0) / std::tan(0.5 * pose.fov_deg * kDegree);
}

std::optional<glm::dvec2> Eye::pixel(glm::dvec3 world) const {
    const glm::dvec3 from = world - position_;
    const double depth = glm::dot(from, ahead_);
    if (!(depth > kNear_m))
        return std::nullopt;
    return 0.5 * size_ + focal_ / depth * glm::dvec2(glm::dot(from, right_), -glm::dot(from, up_));
}

std::optional<glm::dvec3> Eye::ground_under(glm::dvec2 pixel,
                                            const std::function<double(double, double)>& height,
                                            double reach_m) const {
    const glm::dvec2 off = (pixel - 0.5 * size_) / focal_;
    const glm::dvec3 ray = glm::normalize(ahead_ + right_ * off.x - up_ * off.y);
    const auto above = [&](double t) {
        const glm::dvec3 at = position_ + ray * t;
        return at.y - height(at.x, at.z);
    };
    // Steps grow with the distance, so that a pixel far away costs as much as one at the feet.
    double before = 0;
    for (double t = 0.1; t < reach_m; t = t * 1.02 + 0.05) {
        if (above(t) > 0) {
            before = t;
            continue;
        }
        double low = before, high = t;
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (low + high);
            (above(middle) > 0 ? low : high) = middle;
        }
        return position_ + ray * high;
    }
    return std::nullopt;
}

} // namespace sward::app
