// SPDX-License-Identifier: Apache-2.0
// The terms of light (G4) of a volume's blades, as metadata of its grids: a colour alone does not
// say how a thing shines.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "texgen/preset/preset.h"

namespace sward::texgen {

class SparseGrid;
class VdbReader;

inline constexpr const char* kLightVersionKey = "light_version"; ///< int32
inline constexpr int kLightVersion = 1;

/// Keys and values of the metadata, floats: "light_kd" and so on, those of a preset's [light].
[[nodiscard]] std::array<std::pair<std::string, float>, 5> light_terms(const Species& light);

/// What a grid's metadata says; plain meadow grass's where it says nothing, and with a warning
/// where it is of another version. Throws base::Error(kBadInput) for a term that is missing or out
/// of the range that a preset's has.
[[nodiscard]] Species read_light(const VdbReader& reader, const SparseGrid& grid);

} // namespace sward::texgen
