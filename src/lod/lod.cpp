// SPDX-License-Identifier: Apache-2.0
#include "lod/lod.h"

#include <algorithm>

namespace sward::lod {

Bands bands(const Settings& settings, const Projection& projection,
            const scene::LodSpec& overrides) {
    double start = projection.focal_px * projection.blade_width_m / settings.blade_start_px;
    double end = projection.focal_px * projection.blade_width_m / settings.blade_gone_px;
    start = overrides.handover_start_m.value_or(
        std::min(start, overrides.handover_end_m.value_or(start)));
    end = std::max(overrides.handover_end_m.value_or(end), start * 1.01);

    Bands out;
    out.handover = {start, end};
    glm::dvec2 incoming(start, end);
    double next =
        std::max(projection.focal_px * projection.texel_m * settings.texels_per_pixel, end * 1.2);
    for (int k = 0; k < projection.far_levels; ++k) {
        const bool last = k + 1 == projection.far_levels;
        glm::dvec2 outgoing(next, next * (last ? settings.last_band_ratio : settings.band_ratio));
        if (last && overrides.far_end_m) {
            outgoing = {std::max(*overrides.far_end_m / settings.last_band_ratio, incoming.y),
                        *overrides.far_end_m};
            outgoing.y = std::max(outgoing.y, outgoing.x * 1.01);
        }
        out.far[static_cast<std::size_t>(k)] = glm::vec4(incoming, outgoing);
        incoming = outgoing;
        next *= 2;
    }
    return out;
}

} // namespace sward::lod
