// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "assets/image_file.h"
#include "scene/heightfield.h"
#include "scene/scene.h"

namespace sward::assets {

/// A landcover whose classes say more than a density, with the areas and lines over it, on texels
/// of their own: a quarter of the raster's pixels, at least 0.5 m, and coarser where
/// TerrainSpec::classes_mb asks for it. Borders between the raster's pixels wander by a fraction of
/// a pixel, and their squares do not show. `channel`: the raster as check_values leaves it; null:
/// areas and lines alone. Throws Error(kBadInput) where the raster covers nothing of the terrain,
/// and as read_features does.
[[nodiscard]] scene::DensityMask land_mask(const Channel* channel, const scene::TerrainSpec& spec,
                                           const scene::Heightfield& ground);

} // namespace sward::assets
