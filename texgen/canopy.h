// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "shared/blade.h"
#include "texgen/patch.h"

namespace sward::texgen {

/// A blade cut into flat trapezoids, in double: what the rasteriser and the rays see. The chord of
/// a sixteenth of a blade that bends by 50 degrees is off by 0.1 mm at most, far below a texel.
struct Outline {
    static constexpr int kSegments = 16;
    std::array<glm::dvec3, kSegments + 1> centre; ///< patch coordinates, not wrapped
    std::array<double, kSegments + 1> half;       ///< half width
    glm::dvec3 across;                            ///< unit width direction
    glm::dvec3 low, high;                         ///< bounding box

    [[nodiscard]] static double v_at(int i) { return static_cast<double>(i) / kSegments; }
};

[[nodiscard]] Outline outline_of(const shared::BladeRecord& blade);
[[nodiscard]] std::vector<Outline> outlines_of(std::span<const shared::BladeRecord> blades);

/// Top of the highest blade of any variant, metres.
[[nodiscard]] double canopy_height(const Patch& patch);

/// Farthest that any blade reaches sideways from its root, half width included, metres.
[[nodiscard]] double reach(const Patch& patch);

/// Signed distance on a circle of circumference `period`, nearest image.
[[nodiscard]] inline double nearest_image(double d, double period) {
    return d - period * std::round(d / period);
}

} // namespace sward::texgen
