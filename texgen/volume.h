// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "grass/grass_set.h"

namespace sward::texgen {

/// volume.vdb of variant 0 (G1): fog volume `density` and companions `tangent`, `rank`, `seed`;
/// half float, metres, y up, voxels as wide as a texel of level 0. The same set gives the same
/// bytes.
[[nodiscard]] std::vector<std::byte> encode_volume(const grass::GrassSet& set);

/// What a volume holds, read back.
struct VolumeInfo {
    std::vector<std::string> grids;  ///< names, in file order
    std::uint64_t active_voxels = 0; ///< of `density`
    double density_sum = 0;
    double voxel_m = 0;
};
[[nodiscard]] VolumeInfo inspect_volume(const std::vector<std::byte>& bytes);

} // namespace sward::texgen
