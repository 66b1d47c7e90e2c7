// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grass/grass_set.h"
#include "texgen/patch.h"

namespace sward::texgen {

/// Coverage, mean height and place along the blade that rays through the blades meet, at falling
/// elevations; the rays spread evenly over places, azimuths and variants.
[[nodiscard]] std::vector<grass::FarRow> far_table(const Patch& patch, double canopy_m,
                                                   int threads);

/// Rows of a far table before anything is known but their elevations and the slices' shares.
[[nodiscard]] std::vector<grass::FarRow> empty_far_rows();

/// Fills the far rows' shares, so that the textures of each level cover what the rays of the row
/// met, or as near as shells can bring them. Lists the rows at verbosity -v.
void calibrate_shells(grass::GrassSet& set, int threads);

} // namespace sward::texgen
