// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "assets/gdal_scope.h"
#include "assets/image_file.h"
#include "assets/limits.h"
#include "base/error.h"

namespace sward::assets {
namespace {

constexpr std::array<const char*, 4> kDrivers = {"PNG", "GTiff", "JPEG", nullptr};

base::Error bad(const std::filesystem::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    return base::input_error(base::ExitCode::kBadInput, path, 0, what, found, expected);
}

/// Largest value of the type, 0 for floating point; less than 8 bits are told beside the type.
double full_scale_of(GDALRasterBandH band, const std::filesystem::path& path) {
    const GDALDataType type = GDALGetRasterDataType(band);
    if (type == GDT_Float32 || type == GDT_Float64)
        return 0;
    if (type == GDT_UInt16)
        return 65535;
    if (type != GDT_Byte)
        throw bad(path, "type of the pixels", GDALGetDataTypeName(type),
                  "8 or 16 bits unsigned, or floating point");
    const char* bits = GDALGetMetadataItem(band, "NBITS", "IMAGE_STRUCTURE");
    const int count = bits ? std::atoi(bits) : 8;
    return count >= 1 && count < 8 ? double((1 << count) - 1) : 255;
}

/// Indices to the red of their colours.
void look_up(GDALColorTableH table, std::vector<float>& values) {
    std::array<float, 256> red{};
    for (int i = 0; i < std::min(256, GDALGetColorEntryCount(table)); ++i)
        red[static_cast<std::size_t>(i)] = GDALGetColorEntry(table, i)->c1;
    for (float& value : values)
        value = red[static_cast<std::size_t>(std::clamp(value, 0.0f, 255.0f))];
}

} // namespace

Channel read_gdal_channel(const std::filesystem::path& path, int least_side, Palette palette) {
    GdalScope gdal;
    const Dataset dataset = gdal.open(path, kDrivers.data());
    GDALRasterBandH band = dataset && GDALGetRasterCount(dataset.get()) > 0
                               ? GDALGetRasterBand(dataset.get(), 1)
                               : nullptr;
    if (!band)
        throw bad(path, "cannot decode", gdal.error("broken data"), "a whole picture");
    Channel channel;
    channel.width = GDALGetRasterXSize(dataset.get());
    channel.height = GDALGetRasterYSize(dataset.get());
    channel.channels = GDALGetRasterCount(dataset.get());
    check_size(path, channel.width, channel.height, channel.channels, sizeof(float),
               std::filesystem::file_size(path), least_side);
    channel.full_scale = full_scale_of(band, path);
    gdal.read(band, path, channel.values);
    if (GDALColorTableH table = GDALGetRasterColorTable(band);
        table && palette == Palette::kColours) {
        look_up(table, channel.values);
        channel.full_scale = 255;
    }
    return channel;
}

} // namespace sward::assets
