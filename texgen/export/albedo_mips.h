// SPDX-License-Identifier: Apache-2.0
// Albedo and tangents as other engines filter them: mips that keep the coverage, and colour under
// alpha 0.
#pragma once

#include <vector>

#include "shared/types.h"
#include "texgen/export/export_texels.h"

namespace sward::texgen {

struct AlbedoTexel {
    shared::vec3 albedo{0}; ///< linear
    float alpha = 0;
    shared::vec3 tangent{0}; ///< unit in mip 0, a mean above
    float height = 0;        ///< 0 ground .. 1 canopy top
};

struct AlbedoImage {
    int width = 0, height = 0;
    bool repeats_v = false; ///< beside u: a layer; a slice ends at the ground
    std::vector<AlbedoTexel> texels;

    [[nodiscard]] AlbedoTexel& at(int x, int y) {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    [[nodiscard]] const AlbedoTexel& at(int x, int y) const {
        return const_cast<AlbedoImage*>(this)->at(x, y);
    }
};

/// Mip 0 of an image of the set, with nothing under alpha 0. `rows` of empty texels are added above
/// a slice.
[[nodiscard]] AlbedoImage albedo_image(const TexelDecoder& decoder, const ImageSource& source,
                                       int rows = 0);

/// `mips` of them, straight alpha. Colour, tangent and height are means of what stands there, and
/// where alpha is 0 of what stands nearby; `empty` in an image without a blade. In each mip the
/// share of texels that pass an alpha test at 1/2 is that of mip 0 and the mean alpha too, as
/// nearly as its number of texels allows.
[[nodiscard]] std::vector<AlbedoImage> albedo_mips(AlbedoImage image, int mips,
                                                   const AlbedoTexel& empty);

} // namespace sward::texgen
