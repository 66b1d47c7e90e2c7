// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/import/import_field.h"

namespace sward::texgen {

/// A volume's colours as species, so that textures whose texels name one can show them.
struct Palette {
    std::vector<grass::Species> species; ///< 1 to shared::kMaxSpecies, the most area first; without
                                         ///< colours a meadow's alone
    std::vector<std::uint8_t> of_voxel;  ///< empty where there is one
};

/// Groups of voxels whose colours lie along one line from root to tip: as many as it takes for none
/// to be far from its own. The terms of light are the volume's.
[[nodiscard]] Palette palette_of(const VoxelField& field);

} // namespace sward::texgen
