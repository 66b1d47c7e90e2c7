// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "texgen/bake/far_level.h"

namespace sward::texgen {

/// Number of a blade in [0, 1): golden-ratio steps, so that any share of the blades is met evenly;
/// the same in all variants for the blades of their common border.
[[nodiscard]] double lot_of(std::int32_t blade);

/// Texels at least half covered over mean coverage: what an alpha test sees of an image.
[[nodiscard]] double alpha_ratio(const TexelImage& image);

/// A mip that keeps what an alpha test sees (B5): a blade's texels become more than half opaque
/// where their coverage exceeds the blade's own number, as many as `ratio` asks for, so that
/// representative blades stay whole and none is averaged into grey; the others become thinner. The
/// mean coverage stays, of the image and of texels of any coverage.
void keep_alpha(TexelImage& image, double ratio);

/// Codes the images of one slab (shaders/shared/grass_layout.h).
class Coder {
public:
    Coder(const BakeFrame& frame, std::span<const shared::BladeRecord> blades, const Slab& slab)
        : frame_(frame), blades_(blades), slab_(slab) {}

    /// `id` and `shape` are the two planes' texels of this mip.
    void code(const TexelImage& image, std::uint8_t* id, std::uint8_t* shape) const;

private:
    void code_shape(const shared::BladeRecord& blade, float along, glm::dvec2 uv,
                    std::uint8_t* out) const;

    const BakeFrame& frame_;
    std::span<const shared::BladeRecord> blades_;
    const Slab& slab_;
};

} // namespace sward::texgen
