// SPDX-License-Identifier: Apache-2.0
// B1: one image a variant, whose alpha is the height of the blade that is seen from above, instead
// of an image a layer.
#pragma once

#include <span>
#include <vector>

#include "texgen/bake/far_level.h"

namespace sward::texgen {

/// What shows from above through all slabs (`column`, lowest first): texels are wholly covered or
/// not at all, whole blades at a time, and as many as the slabs together cover.
[[nodiscard]] std::vector<Texel> seen_from_above(std::span<const Slab> column,
                                                 std::span<const Outline> outlines,
                                                 SlabRaster& raster);

/// Turns the coverage of texels that are at least half covered into their blade's height over the
/// canopy's, as frame.preset's coding stores it, and clears the others.
void heights_for_coverage(TexelImage& image, const BakeFrame& frame, int variant);

} // namespace sward::texgen
