// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/heightfield.h"
#include "scene/scene.h"

namespace sward::scene {

/// Elevation as the core reads it: .hgt, .raw with its header, .raw and .r16 with size_m and
/// height_m. Throws Error(kBadInput) for another kind, and as read_hgt does.
[[nodiscard]] Heightfield read_core_elevation(const TerrainSpec& spec);

} // namespace sward::scene
