// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace sward::app {

/// A view as the overlays need it: world points to pixels and back. The projection is the
/// renderer's own.
class Eye {
public:
    /// `pose` above the datum; `size` in the pixels that the mouse counts in.
    Eye(const scene::Pose& pose, glm::dvec2 size);

    /// The pixel of a world point, right and down from the top left; nothing nearer than kNear_m
    /// ahead.
    [[nodiscard]] std::optional<glm::dvec2> pixel(glm::dvec3 world) const;
    /// Where the view through a pixel first meets a ground; nothing within `reach_m`. `height` is
    /// the ground's at x, z.
    [[nodiscard]] std::optional<glm::dvec3>
    ground_under(glm::dvec2 pixel, const std::function<double(double, double)>& height,
                 double reach_m) const;
    [[nodiscard]] glm::dvec3 position() const { return position_; }
    [[nodiscard]] glm::dvec3 ahead() const { return ahead_; }
    /// Metres that a pixel spans at a distance.
    [[nodiscard]] double metres_per_pixel(double distance_m) const { return distance_m / focal_; }

    static constexpr double kNear_m = 0.1;

private:
    glm::dvec3 position_, ahead_, right_, up_;
    glm::dvec2 size_;
    double focal_; // pixels
};

} // namespace sward::app
