// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "texgen/far_level.h"

namespace sward::texgen {

/// Texels at least half covered over mean coverage: what an alpha test sees of an image.
[[nodiscard]] double alpha_ratio(const TexelImage& image);

/// A mip that keeps what an alpha test sees (B5): the texels of some blades become more than half opaque, whole blades at a
/// time, as many as `ratio` asks for, and the others thinner, so that the image's mean coverage stays.
/// `common`: blades that all variants share; they are decided first, so that variants agree on their border.
void keep_alpha(TexelImage& image, double ratio, std::span<const char> common);

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
