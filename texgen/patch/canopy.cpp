// SPDX-License-Identifier: Apache-2.0
#include "texgen/patch/canopy.h"

#include <algorithm>
#include <cmath>

namespace sward::texgen {

Outline outline_of(const shared::BladeRecord& blade,
                   std::span<const shared::GrassAppearance> species) {
    const shared::BladeOutline outline = species[species_of(blade)].outline;
    Outline o;
    const glm::dvec3 root(blade.root.x, 0.0, blade.root.y);
    const glm::dvec3 v1(blade.v1);
    const glm::dvec3 v2(blade.v2);
    const double facing = blade.shape.x;
    o.across = {std::cos(facing), 0.0, std::sin(facing)};
    o.low = glm::dvec3(1e30);
    o.high = glm::dvec3(-1e30);
    for (int i = 0; i <= Outline::kSegments; ++i) {
        const double v = shared::blade_station(static_cast<float>(i) / Outline::kSegments, outline);
        o.v[i] = v;
        o.centre[i] = root + 2 * v * (1 - v) * v1 + v * v * v2; // blade_curve
        o.half[i] = blade.v1.w * shared::blade_width_at(static_cast<float>(v), outline);
        o.low = glm::min(o.low, glm::min(o.centre[i] - o.half[i] * o.across,
                                         o.centre[i] + o.half[i] * o.across));
        o.high = glm::max(o.high, glm::max(o.centre[i] - o.half[i] * o.across,
                                           o.centre[i] + o.half[i] * o.across));
    }
    return o;
}

std::vector<Outline> outlines_of(std::span<const shared::BladeRecord> blades,
                                 std::span<const shared::GrassAppearance> species) {
    std::vector<Outline> outlines;
    outlines.reserve(blades.size());
    for (const shared::BladeRecord& blade : blades)
        outlines.push_back(outline_of(blade, species));
    return outlines;
}

double canopy_height(const Patch& patch) {
    double top = 0;
    for (const shared::BladeRecord& blade : patch.blades) {
        const double a = blade.v1.y, b = blade.v2.y;
        const double v = 2 * a > b ? std::clamp(a / (2 * a - b), 0.0, 1.0) : 1.0; // where y turns
        top = std::max(top, 2 * v * (1 - v) * a + v * v * b);
    }
    return top;
}

double reach(const Patch& patch) {
    double farthest = 0;
    for (const shared::BladeRecord& blade : patch.blades) {
        const glm::dvec3 v1(blade.v1), v2(blade.v2);
        for (int i = 0; i <= Outline::kSegments; ++i) {
            const double v = static_cast<double>(i) / Outline::kSegments;
            const glm::dvec3 at = 2 * v * (1 - v) * v1 + v * v * v2;
            farthest = std::max(farthest, std::hypot(at.x, at.z) + blade.v1.w);
        }
    }
    return farthest;
}

} // namespace sward::texgen
