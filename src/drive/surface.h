// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "scene/ground_cover.h"

namespace sward::drive {

/// What a wheel stands on.
enum class Surface { kGrass, kWetGrass, kRoad, kSoil, kSand };
inline constexpr std::size_t kSurfaces = 5;
inline constexpr std::array<const char*, kSurfaces> kSurfaceNames = {"grass", "wet grass", "road",
                                                                     "soil", "sand"};

/// Asphalt is road; gravel and rock are loose or uneven enough to count as soil; the bed of water
/// is as soft as sand; grass at a shore is wet.
[[nodiscard]] Surface surface_of(const scene::GroundCover& cover);

} // namespace sward::drive
