// SPDX-License-Identifier: Apache-2.0
// What the march reads of a canopy that is the same everywhere, as tall as `canopy` (m) and half as
// opaque from above as `area` (blade area over ground area) says: for sets that tests make
// themselves.
#pragma once

#include <cstring>

#include <glm/gtc/packing.hpp>

#include "grass/grass_set.h"
#include "shared/march.h"

namespace sward::tests {

inline grass::TextureArray even_images(glm::ivec3 shape, grass::TexelFormat format,
                                       const std::vector<std::uint8_t>& texel) {
    grass::TextureArray array{shape.x, shape.y, shape.z, {}, format};
    for (int mip = 0; mip == 0 || (std::max(shape.x, shape.y) >> mip) > 0; ++mip) {
        const std::size_t texels = static_cast<std::size_t>(std::max(1, shape.x >> mip)) *
                                   static_cast<std::size_t>(std::max(1, shape.y >> mip)) *
                                   static_cast<std::size_t>(shape.z);
        std::vector<std::uint8_t> bytes(texels * texel.size());
        for (std::size_t i = 0; i < bytes.size(); i += texel.size()) {
            std::memcpy(&bytes[i], texel.data(), texel.size());
        }
        array.mips.push_back(std::move(bytes));
    }
    return array;
}

inline grass::FarMedium even_march(float side, float canopy, int variants, float area = 1) {
    grass::FarMedium march;
    for (int i = 0; i <= shared::kMarchLayers; ++i) {
        const float height = static_cast<float>(i) / shared::kMarchLayers,
                    above = area * (1 - height);
        march.medium.edges[i] = {above, 0.5f * above, above, canopy * height};
    }
    for (int i = 0; i < shared::kMarchLayers; ++i) {
        march.medium.layers[i] = {0.8f, 0.5f, 0, 0};
        march.medium.level_tint[i] = march.medium.steep_tint[i] = {1, 1, 1, 0};
    }
    march.medium.gloss = {1, 1, 0.06f, 18};
    march.medium.side_m = side;
    march.medium.canopy_m = canopy;
    march.medium.translucency = 0.4f;
    march.medium.variants = variants;
    shared::fill_views(march.medium);
    std::vector<std::uint8_t> density(8);
    const float values[4] = {0.08f, 0.15f, 0.03f, 1};
    for (std::size_t c = 0; c < 4; ++c) {
        const std::uint16_t half = glm::packHalf1x16(values[c]);
        std::memcpy(&density[2 * c], &half, 2);
    }
    const auto arrays = [&](glm::ivec3 shape) {
        return grass::MarchArrays{
            even_images(shape, grass::TexelFormat::kRgba16f, density),
            even_images(shape, grass::TexelFormat::kRgba8, {128, 204, 128, 128})};
    };
    const int columns = shared::kMarchTexels >> shared::kColumnBase;
    march.columns = arrays({columns, columns, variants * shared::kMarchLayers});
    for (int k = 0; k < shared::kMarchSets; ++k) {
        march.slabs[static_cast<std::size_t>(k)] =
            arrays({shared::kMarchTexels >> k, grass::kMarchRows,
                    variants * 2 * (shared::kFinestSlabs >> k)});
    }
    march.correction.assign(grass::kMarchCorrections, 1.0f);
    return march;
}

} // namespace sward::tests
