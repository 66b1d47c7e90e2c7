// SPDX-License-Identifier: Apache-2.0
#include "grass/far_medium.h"

#include <cstring>

#include <fmt/format.h>

#include "base/error.h"
#include "grass/set_files.h"
#include "grass/set_json.h"
#include "shared/march.h"

namespace sward::grass {

using base::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::vector<float> read_numbers(const SetJson& set, const json& object, const char* key,
                                std::size_t count, glm::dvec2 range) {
    std::vector<float> numbers;
    for (const json& value : set.array(object, key, count, count))
        numbers.push_back(static_cast<float>(set.in_range(value, key, range.x, range.y)));
    return numbers;
}

/// One of the march's arrays: its shape is the reader's to know.
TextureArray read_march_array(const SetJson& set, const fs::path& directory,
                              const std::string& name, glm::ivec3 shape, TexelFormat format) {
    TextureArray array = read_array(set, directory, name, shape.z, format);
    if (array.width != shape.x || array.height != shape.y)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "size",
                                fmt::format("{} x {}", array.width, array.height),
                                fmt::format("{} x {}", shape.x, shape.y));
    return array;
}

} // namespace

TextureArray encode_correction(const FarMedium& march) {
    TextureArray array{
        shared::kMarchElevations, shared::kMarchMips, kMarchKinds, {}, TexelFormat::kRgba32f};
    array.mips.emplace_back(march.correction.size() * sizeof(float));
    std::memcpy(array.mips[0].data(), march.correction.data(), array.mips[0].size());
    return array;
}

void decode_correction(const TextureArray& array, const std::filesystem::path& name,
                       FarMedium& march) {
    if (array.width != shared::kMarchElevations || array.height != shared::kMarchMips)
        throw base::input_error(
            base::ExitCode::kBadInput, name, 0, "size",
            fmt::format("{} x {}", array.width, array.height),
            fmt::format("{} x {}", shared::kMarchElevations, shared::kMarchMips));
    march.correction.resize(kMarchCorrections);
    std::memcpy(march.correction.data(), array.mips[0].data(), kMarchCorrections * sizeof(float));
    for (const float factor : march.correction)
        if (!(factor >= 0 && factor <= 100))
            throw base::input_error(base::ExitCode::kBadInput, name, 0, "factor",
                                    std::to_string(factor), "0 to 100");
}

void read_march(const SetJson& set, const fs::path& directory, GrassSet& out) {
    const json& march = set.at(set.root(), "march");
    shared::MarchMedium& medium = out.march.medium;
    constexpr double kMostArea = 1e6; // m2 over a m2
    const auto rows = [&](const char* key, std::size_t count, std::size_t numbers,
                          glm::dvec2 range) {
        std::vector<std::vector<float>> out_rows;
        for (const json& row : set.array(march, key, count, count))
            out_rows.push_back(read_numbers(set, json{{key, row}}, key, numbers, range));
        return out_rows;
    };
    const auto edges = rows("edges", shared::kMarchLayers + 1, 4, {0, kMostArea});
    for (std::size_t i = 0; i < edges.size(); ++i) {
        medium.edges[i] = {edges[i][0], edges[i][1], edges[i][2], edges[i][3]};
        if (i > 0 && !(edges[i][3] > edges[i - 1][3]))
            set.refuse("edges", fmt::format("height {} after {}", edges[i][3], edges[i - 1][3]),
                       "rising heights");
    }
    const auto layers = rows("layers", shared::kMarchLayers, 2, {0, 1.0001});
    const auto level = rows("level_tint", shared::kMarchLayers, 3, {0, 10}),
               steep = rows("steep_tint", shared::kMarchLayers, 3, {0, 10});
    for (std::size_t i = 0; i < layers.size(); ++i) {
        medium.layers[i] = {layers[i][0], layers[i][1], 0, 0};
        medium.level_tint[i] = {level[i][0], level[i][1], level[i][2], 0};
        medium.steep_tint[i] = {steep[i][0], steep[i][1], steep[i][2], 0};
    }
    const auto slopes = rows("slopes", shared::kMarchElevations, 4, {-1, 1});
    for (std::size_t i = 0; i < slopes.size(); ++i)
        medium.slopes[i] = {slopes[i][0], slopes[i][1], slopes[i][2], slopes[i][3]};
    const std::vector<float> look = read_numbers(set, march, "look", 4, {0, 10000});
    medium.gloss = {look[0], look[1], look[2], look[3]};
    medium.side_m = out.side_m;
    medium.canopy_m = out.canopy_m;
    medium.translucency = set.real(march, "translucency", 0, 1);
    medium.variants = out.variants;
    shared::fill_views(medium);
    constexpr int kTexels = shared::kMarchTexels, kRows = kMarchRows;
    const int columns = kTexels >> shared::kColumnBase;
    const auto arrays = [&](const std::string& density, const std::string& fibres,
                            glm::ivec3 shape) {
        return MarchArrays{read_march_array(set, directory, density, shape, TexelFormat::kRgba16f),
                           read_march_array(set, directory, fibres, shape, TexelFormat::kRgba8)};
    };
    out.march.columns = arrays(kColumnsFile, kColumnFibresFile,
                               {columns, columns, out.variants * shared::kMarchLayers});
    for (int k = 0; k < shared::kMarchSets; ++k)
        out.march.slabs[k] =
            arrays(slabs_file(k), slab_fibres_file(k),
                   {kTexels >> k, kRows, out.variants * 2 * (shared::kFinestSlabs >> k)});
    decode_correction(
        read_array(set, directory, kCorrectionFile, kMarchKinds, TexelFormat::kRgba32f),
        directory / kCorrectionFile, out.march);
}

} // namespace sward::grass
