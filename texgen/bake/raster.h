// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "texgen/patch/canopy.h"

namespace sward::texgen {

/// The three families of flat textures (G1, G3): which axis the slab cuts, and which axes its image
/// spans.
enum class Family { kLayer, kSliceX, kSliceZ };

struct Axes {
    int slab, u, v; ///< 0 x, 1 y, 2 z
};
[[nodiscard]] constexpr Axes axes_of(Family family) {
    return family == Family::kLayer    ? Axes{1, 0, 2}
           : family == Family::kSliceX ? Axes{0, 2, 1}
                                       : Axes{2, 0, 1};
}

/// One slab and the image it is projected onto. Row 0 and column 0 begin at 0 of their axes.
struct Slab {
    Family family = Family::kLayer;
    double low = 0, high = 0;        ///< along the slab axis, metres
    int width = 0, height = 0;       ///< texels
    double texel_u = 0, texel_v = 0; ///< metres
    double side = 0;                 ///< period of x and z
    bool wrap = true;                ///< false: cut at the patch's edge (Preset::wrap)
};

/// What the blades show in one texel: the share of its area that any of them covers, and the blade
/// that shows for it: drawn by lot, weighted by the area it covers.
struct Texel {
    float coverage = 0;
    std::int32_t blade = -1;
    float along = 0; ///< mean v of that blade within the texel
};

/// Projects the part of each blade that lies in the slab onto the image, 8 x 8 samples a texel
/// without dilation, so that thin blades keep their area in expectation. One worker's memory,
/// reused from slab to slab.
class SlabRaster {
public:
    /// Valid until the next call.
    [[nodiscard]] const std::vector<Texel>& draw(const Slab& slab, std::span<const Outline> blades);

private:
    struct Corner {
        double s, u, v;
    };
    struct Piece; ///< the convex part of a blade's segment that lies in the slab

    void segment(const Outline& blade, int i, double shift);
    void fill(const Piece& piece);
    void span(int row, int first, int last, const Piece& piece);
    void settle(std::int32_t blade);

    Slab slab_;
    std::vector<Texel> texels_;
    std::vector<std::uint64_t> all_;  ///< samples that any blade covers
    std::vector<std::uint64_t> mask_; ///< samples that the current blade covers
    std::vector<float> along_sum_;
    std::vector<std::uint16_t> total_; ///< samples of all blades so far, overlaps counted twice
    std::vector<std::uint32_t> touched_;
};

} // namespace sward::texgen
