// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/height_map.h"

#include <algorithm>

#include "texgen/bake/texel_coder.h"

namespace sward::texgen {

std::vector<Texel> seen_from_above(std::span<const Slab> column, std::span<const Outline> outlines,
                                   SlabRaster& raster) {
    std::vector<Texel> seen;
    std::vector<Texel> passed; // the blade that a texel met last and did not take, and what it has
                               // covered of it so far
    for (std::size_t i = column.size();
         i-- > 0;) { // from the top down: what is above hides what is below
        const std::vector<Texel>& slab = raster.draw(column[i], outlines);
        seen.resize(slab.size());
        passed.resize(slab.size());
        for (std::size_t t = 0; t < slab.size(); ++t) {
            if (seen[t].blade >= 0 || slab[t].blade < 0)
                continue;
            Texel& here = passed[t]; // an upright blade covers a texel bit by bit, slab after slab
            const float before = here.blade == slab[t].blade ? here.coverage : 0.0f;
            here = {1 - (1 - before) * (1 - slab[t].coverage), slab[t].blade, slab[t].along};
            if (lot_of(here.blade) < here.coverage)
                seen[t] = {1, here.blade, here.along};
        }
    }
    return seen;
}

void heights_for_coverage(TexelImage& image, const BakeFrame& frame, int variant) {
    const std::span<const shared::BladeRecord> blades = frame.patch.variant(variant);
    const int coding = height_coding(frame.preset);
    for (Texel& texel : image.texels) {
        if (texel.blade < 0 || texel.coverage < 0.5f) {
            texel = {};
            continue;
        }
        const shared::BladeRecord& blade = blades[static_cast<std::size_t>(texel.blade)];
        const float y =
            shared::blade_curve(shared::vec3(blade.v1), shared::vec3(blade.v2), texel.along).y;
        const float height = std::clamp(y / static_cast<float>(frame.canopy_m), 0.0f, 1.0f);
        texel.coverage =
            std::max(shared::encode_height(height, coding), 1.0f / 255.0f); // 0 is an empty texel
    }
}

} // namespace sward::texgen
