// SPDX-License-Identifier: Apache-2.0
// Many images in one texture, each with a rim that goes on as the image does, so that filters and
// mips do not mix neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/export/albedo_mips.h"

namespace sward::texgen {

/// How an atlas is cut. Tiles are numbered row by row from the top left.
struct AtlasPlan {
    int tile_width = 0,
        tile_height = 0; ///< multiples of `rim`; more than the images' height where that is none
    int rim = 1;         ///< texels at mip 0, a power of two: mips end where it is one texel
    int columns = 1, rows = 1;
    int mips = 1;

    [[nodiscard]] int width() const { return columns * (tile_width + 2 * rim); }
    [[nodiscard]] int height() const { return rows * (tile_height + 2 * rim); }
    /// Left, top, right and bottom of a tile's image within its rim, 0..1 from the top left, `used`
    /// of its rows from below.
    [[nodiscard]] shared::vec4 place(int tile, int used) const;
};

[[nodiscard]] AtlasPlan plan_atlas(int images, int width, int height);

/// Colour (sRGB, alpha) and tangents (x, y, z * 0.5 + 0.5; height) of the same texels.
struct AlbedoArrays {
    grass::TextureArray albedo, tangent;
};
/// All 0, with `mips`.
[[nodiscard]] AlbedoArrays empty_arrays(int width, int height, int layers, int mips);

/// Puts an image's mips into layer `layer` of arrays of its size.
void store_layer(const std::vector<AlbedoImage>& mips, int layer, AlbedoArrays& out);
/// Puts them into a tile of an atlas of one layer, its rim included.
void store_tile(const std::vector<AlbedoImage>& mips, const AtlasPlan& plan, int tile,
                AlbedoArrays& out);

} // namespace sward::texgen
