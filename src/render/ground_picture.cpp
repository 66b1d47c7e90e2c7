// SPDX-License-Identifier: Apache-2.0
#include "render/ground_picture.h"

namespace sward::render {

double mean_blade_width_m(const grass::GrassSet& set) {
    if (set.blades.empty()) { // a texel is as wide as a blade
        return set.side_m / static_cast<double>(set.levels.front().layers.width);
    }
    double sum = 0;
    for (const shared::BladeRecord& blade : set.blades) {
        sum += 2.0 * blade.v1.w;
    }
    return sum / static_cast<double>(set.blades.size());
}

glm::dvec2 PictureContext::jitter(int of) const {
    const int grid = pictures > 1 ? settings.reference_grid : 1;
    return (glm::dvec2(of % grid, of / grid) + 0.5) / static_cast<double>(grid) - 0.5;
}

blades::CullTests PictureContext::tests() const {
    return settings.tiers == Tiers::kReference ? blades::CullTests{true, false, false, false}
                                               : settings.cull;
}

} // namespace sward::render
