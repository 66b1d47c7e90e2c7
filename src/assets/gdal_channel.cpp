// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "assets/ascii_grid.h"
#include "assets/gdal_scope.h"
#include "assets/image_file.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/room.h"

namespace sward::assets {
namespace {

constexpr std::array<const char*, 5> kDrivers = {"PNG", "GTiff", "JPEG", "AAIGrid", nullptr};

base::Error bad(const std::filesystem::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    base::refuse_if_starved();
    return base::input_error(base::ExitCode::kBadInput, path, 0, what, found, expected);
}

/// A density's number: what stands for 1, 0 where the values are densities. A file that says a
/// scale or an offset is taken at its word.
double read_scale(GDALRasterBandH band, const std::filesystem::path& path,
                  std::vector<float>& values) {
    const double scale = GDALGetRasterScale(band, nullptr),
                 offset = GDALGetRasterOffset(band, nullptr);
    if ((scale != 1 || offset != 0) && !GDALGetRasterColorTable(band)) {
        for (float& value : values)
            value = static_cast<float>(value * scale + offset);
        return 0;
    }
    const GDALDataType type = GDALGetRasterDataType(band);
    const double full = full_scale_of(band);
    if (full == 0 && type != GDT_Float32 && type != GDT_Float64)
        throw bad(path, "type of the pixels", type_name(band),
                  "8 or 16 bits unsigned, or floating point; for classes [terrain.classes]");
    return full;
}

void require_real(GDALRasterBandH band, const std::filesystem::path& path) {
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(band)))
        throw bad(path, "type of the pixels", GDALGetDataTypeName(GDALGetRasterDataType(band)),
                  "whole numbers");
}

/// Indices to the red of their colours, unless they are classes; a colour of alpha 0 is no value,
/// as a pixel's alpha is.
void look_up(GDALColorTableH table, bool classes, std::vector<float>& values) {
    const int count = GDALGetColorEntryCount(table);
    for (float& value : values) {
        if (std::isnan(value))
            continue;
        const GDALColorEntry* colour = value >= 0 && value < static_cast<float>(count)
                                           ? GDALGetColorEntry(table, static_cast<int>(value))
                                           : nullptr;
        if (colour && colour->c4 == 0)
            value = std::numeric_limits<float>::quiet_NaN();
        else if (!classes)
            value = colour ? colour->c1 : 0.0f;
    }
}

} // namespace

Channel read_gdal_channel(const std::filesystem::path& path, const ChannelRequest& request) {
    GdalScope gdal;
    const Dataset dataset = gdal.open(path, kDrivers.data());
    if (!dataset || GDALGetRasterCount(dataset.get()) < 1)
        throw bad(path, "cannot decode", gdal.error("broken data"), "a whole picture");
    Channel channel;
    channel.width = GDALGetRasterXSize(dataset.get());
    channel.height = GDALGetRasterYSize(dataset.get());
    GDALRasterBandH band = choose_band(dataset.get(), path, std::max(request.band, 1), "mask");
    check_size(path, channel.width, channel.height, 1, sizeof(float),
               std::filesystem::file_size(path), request.least_side);
    const bool classes = request.palette == Palette::kIndices;
    std::vector<std::uint8_t> valid;
    if (std::string_view(GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get()))) ==
        "AAIGrid") {
        channel.values =
            read_ascii_grid(path, channel.width, channel.height); // GDAL reads garbage as 0
    } else {
        gdal.read(band, path, channel.values);
        valid = gdal.read_valid(band, path, channel.values);
        if (classes) // landcover often comes as signed or 32 bits
            require_real(band, path);
        else
            channel.full_scale = read_scale(band, path, channel.values);
    }
    for (std::size_t i = 0; i < valid.size(); ++i)
        if (valid[i] == 0)
            channel.values[i] = std::numeric_limits<float>::quiet_NaN();
    if (GDALColorTableH table = GDALGetRasterColorTable(band)) {
        look_up(table, classes, channel.values);
        channel.full_scale = classes ? 0 : 255;
    }
    std::array<double, 6> affine{};
    channel.turned_loose = !GDALGetSpatialRef(dataset.get()) &&
                           GDALGetGeoTransform(dataset.get(), affine.data()) == CE_None;
    if (request.frame)
        channel.placement = place_raster(dataset.get(), path, request.frame);
    return channel;
}

} // namespace sward::assets
