// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "grass/grass_set.h"
#include "texgen/bake/raster.h"
#include "texgen/patch/patch.h"
#include "texgen/preset/preset.h"

namespace sward::base {
class Progress;
}

namespace sward::texgen {

/// What every image of a set shares.
struct BakeFrame {
    const Preset& preset;
    const Patch& patch;
    double canopy_m = 0;
    double offset_range_m = 0;
    std::span<const double>
        seen; ///< heights that rays meet, rising: layers stand where they matter (placing.h)
    int threads = 1;
    base::Progress* progress = nullptr; ///< advances by level_images() a level
};

/// Farthest from a texel of mip 0 to its blade's root, over all levels and families.
[[nodiscard]] double offset_range(const Preset& preset, const Patch& patch);

/// Sizes of one level.
struct LevelPlan {
    int level = 0;
    int size = 0; ///< texels a side
    double texel_m = 0;
    int layers = 0;
    int images = 0; ///< of layers, a variant: 1 for a height map
    int slices = 0; ///< an axis
    int rows = 0;   ///< of a slice
};
[[nodiscard]] LevelPlan plan_level(const Preset& preset, double canopy_m, int level);

/// Images of level `level` that progress counts.
[[nodiscard]] std::size_t level_images(const Preset& preset, int level);

/// Draws level `level` of all variants: layers and both slice families, with mips.
[[nodiscard]] grass::FarLevel bake_level(const BakeFrame& frame, int level);

/// Rows of a slice image: the canopy in texels, rounded up to a multiple of 4.
[[nodiscard]] int slice_rows(double canopy_m, double texel_m);

/// An image of a mip chain before it is coded.
struct TexelImage {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;
};

/// Next mip: coverage is the mean of the children; blade and place come whole from one child,
/// picked by a hash of the texel with the children's coverage as weight, so that representative
/// blades stay (B5) and nothing is averaged across blades. `salt` tells levels, families and mips
/// apart, but not variants: their common border stays common.
[[nodiscard]] TexelImage next_mip(const TexelImage& image, std::uint64_t salt);

} // namespace sward::texgen
