// SPDX-License-Identifier: Apache-2.0
#include "assets/gdal_raster.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "assets/ascii_grid.h"
#include "assets/gdal_scope.h"
#include "assets/limits.h"
#include "assets/units.h"
#include "base/error.h"
#include "base/room.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr double kHighest_m =
    1e5; // and the lowest, negated: anything past it is no height on Earth
// They read one file and follow nothing in it. VRT, HFA, WMS and their like may name other files
// and hosts.
constexpr std::array<const char*, 5> kDrivers = {"GTiff", "AAIGrid", "DTED", "USGSDEM", nullptr};

base::Error bad(const fs::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    base::refuse_if_starved();
    return base::input_error(ExitCode::kBadInput, path, 0, what, found, expected);
}

/// Factor that turns the band's unit into metres.
double unit_of(GDALRasterBandH band, const fs::path& path, bool& has_unit) {
    const std::optional<double> unit = metres_of_unit(GDALGetRasterUnitType(band), has_unit);
    if (!unit)
        throw bad(path, "unit of the heights", base::printable(GDALGetRasterUnitType(band)),
                  "metres or feet");
    return *unit;
}

/// Voids become NaN, the rest metres; anything else that is not a height is refused.
void to_metres(GDALRasterBandH band, const fs::path& path, const std::vector<std::uint8_t>& valid,
               Raster& raster) {
    int has_scale = 0, has_offset = 0, has_nodata = 0;
    GDALGetRasterNoDataValue(band, &has_nodata);
    double scale = GDALGetRasterScale(band, &has_scale),
           offset = GDALGetRasterOffset(band, &has_offset);
    scale = has_scale ? scale : 1;
    offset = has_offset ? offset : 0;
    if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset))
        throw bad(path, "scale of the heights", fmt::format("{} and offset {}", scale, offset),
                  "a scale that is not zero");
    const double unit = unit_of(band, path, raster.has_unit);
    const bool plain = scale == 1 && offset == 0;
    raster.has_unit |= !plain;
    for (std::size_t i = 0; i < raster.values.size(); ++i) {
        float& value = raster.values[i];
        // Scaled, -32000 may be a height.
        const bool no_height = (!valid.empty() && valid[i] == 0) || std::isnan(value) ||
                               (plain && is_bare_void(value, has_nodata != 0));
        const double metres = (double(value) * scale + offset) * unit;
        if (!no_height && !(std::abs(metres) <= kHighest_m))
            throw bad(
                path,
                fmt::format("height at column {}, row {}", i % raster.width, i / raster.width),
                fmt::format("{} m", metres), fmt::format("-{0} to {0} m", kHighest_m));
        value = no_height ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(metres);
    }
}

void read_band(const Dataset& dataset, const fs::path& path, int number, GdalScope& gdal,
               Raster& raster) {
    const std::uint64_t file_bytes = fs::file_size(path);
    raster.width = GDALGetRasterXSize(dataset.get());
    raster.height = GDALGetRasterYSize(dataset.get());
    GDALRasterBandH band = choose_band(dataset.get(), path, number, "height");
    check_size(path, raster.width, raster.height, 1, sizeof(float), file_bytes, 2);
    const GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsComplex(type))
        throw bad(path, "type of the heights", GDALGetDataTypeName(type), "real numbers");
    raster.full_scale = full_scale_of(band);
    std::vector<std::uint8_t> valid;
    if (std::string_view(GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get()))) ==
        "AAIGrid") {
        raster.values =
            read_ascii_grid(path, raster.width, raster.height); // GDAL reads garbage as 0
    } else {
        gdal.read(band, path, raster.values);
        valid = gdal.read_valid(band, path, raster.values);
    }
    to_metres(band, path, valid, raster);
}

} // namespace

Raster read_gdal_raster(const fs::path& path, int band) {
    GdalScope gdal;
    const Dataset dataset = gdal.open(path, kDrivers.data());
    if (!dataset)
        throw bad(path, "cannot read elevation", gdal.error("an unknown format"),
                  "GeoTIFF, .hgt, Arc/Info ASCII grid, DTED, USGS DEM, 16-bit PNG or EXR");
    Raster raster;
    read_band(dataset, path, band, gdal, raster);
    raster.placement = place_raster(dataset.get(), path, nullptr);
    raster.bare_spacing_m = bare_spacing(dataset.get());
    return raster;
}

bool is_bare_void(float value, bool declared) {
    return std::isnan(value) || scene::is_void(value) ||
           (std::isfinite(value) && std::abs(value) >= 3.4e38f) ||
           (!declared && (value == -9999 || value == -99999 || value == -2147483648.0f));
}

std::string gdal_versions() {
    int major = 0, minor = 0, patch = 0;
    OSRGetPROJVersion(&major, &minor, &patch);
    return fmt::format("GDAL {}, PROJ {}.{}.{}", GDALVersionInfo("RELEASE_NAME"), major, minor,
                       patch);
}

} // namespace sward::assets
