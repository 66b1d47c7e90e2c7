// SPDX-License-Identifier: Apache-2.0
// blades.glb: the blades as glTF 2.0 points, so that any tool can show or scatter them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "shared/blade.h"

namespace sward::grass {

/// Blades of all variants and where each begins (variants + 1 offsets).
struct BladeList {
    std::vector<shared::BladeRecord> blades;
    std::vector<std::uint32_t> variant_begin;
};

/// One mesh of POINTS a variant: POSITION is the root (y 0); application attributes, floats in
/// metres and radians: _HEIGHT (of the tip), _WIDTH (full, at the root), _LENGTH (of the curve),
/// _RANK, _SEED, _V1_X, _V1_Y, _V1_Z, _V2_X, ... (relative to the root), _STIFFNESS, _FACING,
/// _DROOP, _SPECIES (number). All of them are single numbers: Blender's importer (4.2 to 5.0) takes
/// one attribute's shape for another's where a mesh has several. Nodes stand side by side along x.
[[nodiscard]] std::vector<std::byte> encode_blades(std::span<const shared::BladeRecord> blades,
                                                   std::span<const std::uint32_t> variant_begin,
                                                   float side_m);

/// Equal to what was encoded; vectors may also stand in one attribute, `_V1`. `name` is for
/// messages. Throws base::Error: kBadInput malformed, outside the patch or not finite, kOverLimit
/// more than 2^24 blades or JSON above its limits.
[[nodiscard]] BladeList decode_blades(std::span<const std::byte> bytes,
                                      const std::filesystem::path& name, float side_m);

} // namespace sward::grass
