// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/hash.h"
#include "texgen/bake/far_level.h"
#include "texgen/bake/footprint.h"

namespace sward::texgen {

TexelImage next_mip(const TexelImage& image, std::uint64_t salt) {
    TexelImage mip{std::max(1, image.width / 2), std::max(1, image.height / 2), {}};
    const std::vector<Footprint> columns = footprints(image.width, mip.width);
    const std::vector<Footprint> rows = footprints(image.height, mip.height);
    mip.texels.reserve(static_cast<std::size_t>(mip.width) * static_cast<std::size_t>(mip.height));
    for (const Footprint& row : rows)
        for (const Footprint& column : columns) {
            float weight[9];
            const Texel* child[9];
            int count = 0;
            float sum = 0;
            for (int j = 0; j < row.count; ++j)
                for (int i = 0; i < column.count; ++i) {
                    const Texel& texel = image.texels[static_cast<std::size_t>(row.index[j]) *
                                                          static_cast<std::size_t>(image.width) +
                                                      static_cast<std::size_t>(column.index[i])];
                    if (texel.blade < 0)
                        continue;
                    child[count] = &texel;
                    weight[count] = texel.coverage * row.share[j] * column.share[i];
                    sum += weight[count++];
                }
            Texel out;
            if (count > 0) {
                float pick = static_cast<float>(base::hash_unit(salt, 0, mip.texels.size())) * sum;
                int chosen = 0;
                while (chosen + 1 < count && pick >= weight[chosen])
                    pick -= weight[chosen++];
                out = {sum, child[chosen]->blade, child[chosen]->along};
            }
            mip.texels.push_back(out);
        }
    return mip;
}

} // namespace sward::texgen
