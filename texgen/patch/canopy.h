// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "shared/blade.h"
#include "shared/grass_layout.h"
#include "texgen/patch/patch.h"

namespace sward::texgen {

/// A blade cut into flat trapezoids, in double: what the rasteriser and the rays see. The chord of
/// a sixteenth of a blade that bends by 50 degrees is off by 0.1 mm at most, far below a texel.
struct Outline {
    static constexpr int kSegments = 16;
    std::array<double, kSegments + 1> v;          ///< place along the blade; half of them on a head
    std::array<glm::dvec3, kSegments + 1> centre; ///< patch coordinates, not wrapped
    std::array<double, kSegments + 1> half;       ///< half width
    glm::dvec3 across;                            ///< unit width direction
    glm::dvec3 low, high;                         ///< bounding box

    /// v between stations i and i + 1.
    [[nodiscard]] double between(int i, double share) const {
        return std::lerp(v[static_cast<std::size_t>(i)], v[static_cast<std::size_t>(i) + 1], share);
    }
};

/// `species`: the set's looks, by number.
[[nodiscard]] Outline outline_of(const shared::BladeRecord& blade,
                                 std::span<const shared::GrassAppearance> species);
[[nodiscard]] std::vector<Outline> outlines_of(std::span<const shared::BladeRecord> blades,
                                               std::span<const shared::GrassAppearance> species);

/// The species of a blade, an index into the set's looks.
[[nodiscard]] inline std::size_t species_of(const shared::BladeRecord& blade) {
    return static_cast<std::size_t>(blade.shape.w);
}

/// Top of the highest blade of any variant, metres.
[[nodiscard]] double canopy_height(const Patch& patch);

/// Farthest that any blade reaches sideways from its root, half width included, metres: an upper
/// bound.
[[nodiscard]] double reach(const Patch& patch);

/// Signed distance on a circle of circumference `period`, nearest image.
[[nodiscard]] inline double nearest_image(double d, double period) {
    return d - period * std::round(d / period);
}

} // namespace sward::texgen
