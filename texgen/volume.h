// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "grass/grass_set.h"

namespace sward::texgen {

/// volume.vdb of variant 0 (G1): fog volume `density` and companions `tangent`, `rank`, `seed`; half float, metres, y up,
/// voxels as wide as a texel of level 0. The same set gives the same bytes.
[[nodiscard]] std::vector<std::byte> encode_volume(const grass::GrassSet& set);

} // namespace sward::texgen
