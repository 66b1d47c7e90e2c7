// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/export_texels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "grass/ktx2.h"
#include "shared/grass_layout.h"
#include "shared/shading.h"

namespace sward::texgen {

TexelValues TexelDecoder::texel(const ImageSource& source, int x, int row) const {
    const grass::TextureArray& array = *source.array;
    const int y = source.slice ? array.height - 1 - row : row;
    const std::size_t bytes = grass::mip_bytes(array, 0) / static_cast<std::size_t>(array.layers);
    const std::size_t t = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(array.width) +
                               static_cast<std::size_t>(x));
    const std::uint8_t* id =
        array.mips[0].data() + bytes * static_cast<std::size_t>(source.id_index) + t;
    const std::uint8_t* shape =
        array.mips[0].data() + bytes * static_cast<std::size_t>(source.shape_index) + t;
    TexelValues v;
    if (id[0] == 0)
        return v;
    const bool height_map =
        !source.slice && set_.height_coding != shared::kHeightNone; // B1: the byte is a height
    v.coverage = height_map ? 1 : id[0] / 255.0;
    v.rank = (id[1] + 0.5) / 256;
    v.seed = (id[2] + 0.5) / 256;
    v.species = std::min(shared::decode_species(id[3]), static_cast<int>(set_.species.size()) - 1);
    v.along = shared::decode_along(id[3]);
    v.albedo = shared::blade_albedo(set_.species[static_cast<std::size_t>(v.species)].look,
                                    {v.rank, v.seed}, static_cast<float>(v.along), 1);
    v.tangent = shared::decode_tangent(shared::vec2(shape[0], shape[1]) / 255.0f);
    v.offset =
        shared::decode_offset(shared::vec2(shape[2], shape[3]) / 255.0f, set_.offset_range_m);
    v.height = source.slice ? (y + 0.5) / array.height
               : height_map ? shared::decode_height(id[0] / 255.0f, set_.height_coding)
                            : source.place_m / set_.canopy_m;
    return v;
}

std::uint8_t byte_of(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

double srgb(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

std::vector<ImageSource> image_sources(const grass::GrassSet& set) {
    const grass::FarLevel& level = set.levels.front();
    const int layers = grass::layer_images(set, level); // 1 for a height map
    std::vector<ImageSource> all;
    for (int v = 0; v < set.variants; ++v) {
        for (int i = 0; i < layers; ++i) {
            ImageSource source{
                fmt::format("{}{}_{}", kVariantPrefix, v,
                            layers == 1 ? std::string("height-map") : fmt::format("layer{:02}", i)),
                &level.layers, shared::layer_index(v, i, layers, shared::kPlaneId),
                shared::layer_index(v, i, layers, shared::kPlaneShape), v};
            const auto k = static_cast<std::size_t>(i);
            source.place_m = layers == 1 ? set.canopy_m : level.layer_heights[k];
            source.from_m = layers == 1 ? 0 : level.layer_edges[k];
            source.to_m = layers == 1 ? set.canopy_m : level.layer_edges[k + 1];
            all.push_back(source);
        }
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < level.slice_count; ++i) {
                ImageSource source{
                    fmt::format("{}{}_slice-{}{:02}", kVariantPrefix, v,
                                axis == shared::kAxisX ? 'x' : 'z', i),
                    &level.slices,
                    shared::slice_index(v, axis, i, level.slice_count, shared::kPlaneId),
                    shared::slice_index(v, axis, i, level.slice_count, shared::kPlaneShape),
                    v,
                    true,
                    axis};
                const double thick = static_cast<double>(set.side_m) / level.slice_count;
                source.place_m = (i + 0.5) * set.side_m / level.slice_count;
                source.from_m = i * thick;
                source.to_m = (i + 1) * thick;
                all.push_back(source);
            }
    }
    return all;
}

} // namespace sward::texgen
