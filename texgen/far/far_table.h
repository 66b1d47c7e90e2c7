// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grass/grass_set.h"
#include "texgen/far/far_light.h"

namespace sward::texgen {

/// What rays through a canopy meet at falling elevations, and its light. The rays spread evenly
/// over places, azimuths and variants.
struct FarTable {
    std::vector<grass::FarRow>
        rows; ///< of the canopy at rest; the shells' shares are calibrate_shells' to fill
    grass::FarLight light; ///< at rest and leaning; at rest its coverage and heights are the rows'
};
/// `rays`: of a view at rest (kFarRays); a standard error of 0.5 / sqrt(rays) of its coverage at
/// most. Time grows with them.
[[nodiscard]] FarTable far_table(const Canopy& canopy, int rays, int threads);

/// Rows of a far table before anything is known but their elevations and the slices' shares.
[[nodiscard]] std::vector<grass::FarRow> empty_far_rows();

/// Fills the far rows' shares, so that the textures of each level cover what the rays of the row
/// met, or as near as shells can bring them. Lists the rows at verbosity -v.
void calibrate_shells(grass::GrassSet& set, int rays, int threads);

} // namespace sward::texgen
