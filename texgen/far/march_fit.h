// SPDX-License-Identifier: Apache-2.0
// The correction of the march's optical depth: an average of gaps is not a gap. Found so that what
// the march sees of the canopy, by kind of texture, footprint, elevation and density, is in the
// mean what rays through the blades see.
#pragma once

#include <functional>
#include <optional>

#include "texgen/far/march_builder.h"
#include "texgen/patch/rays.h"

namespace sward::texgen {

/// Height (m) at which a ray that comes down from the canopy's top meets grass of at most this
/// density; none: the ground.
using HeightCaster = std::function<std::optional<double>(const SampleRay& ray, std::uint64_t number,
                                                         double density)>;

/// FarMedium::correction. `rays`: of a view, at most (kFarRays); time grows
/// with them up to some 6,000.
[[nodiscard]] std::vector<float> fit_march(const MarchData& data, const HeightCaster& truth,
                                           int rays, int threads);

/// Heights (m, rising) that rays meet from grazing views to straight down, as many of each: where
/// the columns' layers have to be thin.
[[nodiscard]] std::vector<double> heights_met(const HeightCaster& truth, double side_m,
                                              double canopy_m);

/// Rays through the blades of all variants.
[[nodiscard]] HeightCaster cast_blades(const Patch& patch, double canopy_m);

} // namespace sward::texgen
