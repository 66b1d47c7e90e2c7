// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/atlas.h"

#include <algorithm>
#include <bit>

#include "grass/ktx2.h"

namespace sward::texgen {
namespace {

constexpr int kRimShare = 32; // of a tile's width: 16 texels of 512, five mips

void store(const AlbedoTexel& texel, std::size_t at, std::size_t mip, AlbedoArrays& out) {
    std::uint8_t* albedo = out.albedo.mips[mip].data() + 4 * at;
    std::uint8_t* tangent = out.tangent.mips[mip].data() + 4 * at;
    for (int c = 0; c < 3; ++c) {
        albedo[c] = byte_of(srgb(texel.albedo[c]));
        tangent[c] = byte_of(texel.tangent[c] * 0.5 + 0.5);
    }
    albedo[3] = byte_of(texel.alpha);
    tangent[3] = byte_of(texel.height);
}

} // namespace

shared::vec4 AtlasPlan::place(int tile, int used) const {
    const int left = tile % columns * (tile_width + 2 * rim) + rim,
              bottom = tile / columns * (tile_height + 2 * rim) + rim + tile_height;
    const auto w = static_cast<float>(width()), h = static_cast<float>(height());
    return {static_cast<float>(left) / w, static_cast<float>(bottom - used) / h,
            static_cast<float>(left + tile_width) / w, static_cast<float>(bottom) / h};
}

AtlasPlan plan_atlas(int images, int width, int height) {
    AtlasPlan plan;
    plan.rim =
        static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(1, width / kRimShare))));
    const auto whole = [&](int texels) { return (texels + plan.rim - 1) / plan.rim * plan.rim; };
    plan.tile_width = width;
    plan.tile_height = whole(height);
    plan.mips = std::bit_width(static_cast<unsigned>(plan.rim));
    while (plan.columns < images && // nearly square, never taller than wide
           plan.columns * (plan.tile_width + 2 * plan.rim) <
               (images + plan.columns - 1) / plan.columns * (plan.tile_height + 2 * plan.rim))
        ++plan.columns;
    plan.rows = (images + plan.columns - 1) / plan.columns;
    return plan;
}

AlbedoArrays empty_arrays(int width, int height, int layers, int mips) {
    AlbedoArrays out{{width, height, layers, {}, grass::TexelFormat::kRgba8Srgb},
                     {width, height, layers, {}, grass::TexelFormat::kRgba8}};
    for (grass::TextureArray* array : {&out.albedo, &out.tangent})
        for (int m = 0; m < mips; ++m)
            array->mips.emplace_back(grass::mip_bytes(*array, m));
    return out;
}

void store_layer(const std::vector<AlbedoImage>& mips, int layer, AlbedoArrays& out) {
    for (std::size_t m = 0; m < out.albedo.mips.size(); ++m) {
        const std::size_t count = mips[m].texels.size();
        for (std::size_t i = 0; i < count; ++i)
            store(mips[m].texels[i], static_cast<std::size_t>(layer) * count + i, m, out);
    }
}

void store_tile(const std::vector<AlbedoImage>& mips, const AtlasPlan& plan, int tile,
                AlbedoArrays& out) {
    for (int m = 0; m < plan.mips; ++m) {
        const AlbedoImage& image = mips[static_cast<std::size_t>(m)];
        const int rim = plan.rim >> m, left = tile % plan.columns * (image.width + 2 * rim),
                  top = tile / plan.columns * (image.height + 2 * rim);
        for (int y = -rim; y < image.height + rim; ++y)
            for (int x = -rim; x < image.width + rim; ++x) {
                const int row = image.repeats_v ? (y + image.height) % image.height
                                                : std::clamp(y, 0, image.height - 1);
                const auto at = static_cast<std::size_t>(top + rim + y) *
                                    static_cast<std::size_t>(plan.width() >> m) +
                                static_cast<std::size_t>(left + rim + x);
                store(image.at((x + image.width) % image.width, row), at,
                      static_cast<std::size_t>(m), out);
            }
    }
}

} // namespace sward::texgen
