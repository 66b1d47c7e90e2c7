// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/lod.h"

namespace sward::lod {

/// Tier selection by projected size; distances follow from the focal length in pixels, so that
/// field of view, resolution and altitude all work.
struct Settings {
    /// A blade starts to leave geometry at this width in pixels, and has left at `blade_gone_px`.
    /// Thinner keeps more geometry: blades drawn grow with the square of the distance.
    double blade_start_px = 1.3;
    double blade_gone_px = 0.7;
    /// Far level 1 begins where a pixel covers this many of level 0's texels; each further level at
    /// twice the distance. Smaller saves fragments, larger keeps more parallax between layers.
    double texels_per_pixel = 3.2;
    double band_ratio =
        1.3; ///< end / start of the bands between far levels; fragments double inside a band
    double last_band_ratio =
        1.6; ///< likewise from the last level to the ground: longer, it is the eye's last cue
};

/// Distances in metres. Level k of the far tier takes a blade over in far[k].xy and hands it on in
/// far[k].zw.
struct Bands {
    glm::vec2 handover{0};
    std::array<glm::vec4, shared::kMaxFarLevels> far{};
};

/// `focal_px`: pixels that a metre covers at one metre; `blade_width_m`: mean full width;
/// `texel_m`: of far level 0.
struct Projection {
    double focal_px = 0;
    double blade_width_m = 0;
    double texel_m = 0;
    int far_levels = 0;
};
[[nodiscard]] Bands bands(const Settings& settings, const Projection& projection,
                          const scene::LodSpec& overrides);

} // namespace sward::lod
