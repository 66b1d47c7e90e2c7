// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "sward/camera.h"

namespace sward::render {

/// A camera as the renderer draws it: its own depth (reversed, no far plane) in the place of the
/// host's.
struct Lens {
    glm::dvec3 eye{0};  ///< world metres
    glm::dmat4 turn{1}; ///< world to the eye's axes
    glm::dmat4 clip_from_eye{1};
    double near_m = kNear_m;
    double fov_deg = 60;      ///< vertical, of a centred lens of this scale
    bool mirrored = false;    ///< front faces are clockwise
    glm::dvec2 host_depth{0}; ///< the host's depth buffer holds x + y / distance along the axis

    /// Pixels that a metre covers at one metre, in a picture of this size.
    [[nodiscard]] double focal_px(int width, int height) const;
};

/// Throws Error(kBadInput) where a matrix is none of a camera's.
[[nodiscard]] Lens lens_of(const Camera& camera);

} // namespace sward::render
