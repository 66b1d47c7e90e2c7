// SPDX-License-Identifier: Apache-2.0
#include "assets/gdal_scope.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/room.h"

namespace sward::assets {
namespace {

void keep(CPLErr level, CPLErrorNum, const char* message) {
    auto* error = static_cast<std::optional<std::string>*>(CPLGetErrorHandlerUserData());
    if (level >= CE_Failure && !*error)
        *error = message;
}

constexpr std::uint64_t kMostCrsBytes = 65536;

/// Not GDALAllRegister: that takes a second, loads plugins, and brings drivers that follow
/// references.
bool register_drivers() {
    GDALRegister_GTiff();
    GDALRegister_AAIGrid();
    GDALRegister_DTED();
    GDALRegister_USGSDEM();
    GDALRegister_PNG();
    GDALRegister_JPEG();
    RegisterOGRGeoJSON();
    RegisterOGRGeoPackage();
    OSRSetPROJEnableNetwork(0);
    return true;
}

/// Absolute: a relative name such as "GTIFF_DIR:1:x" could be an instruction to a driver.
std::string plain_path(const std::filesystem::path& path) {
    const std::string absolute = std::filesystem::absolute(path).lexically_normal().string();
    if (absolute.starts_with("/vsi"))
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "path",
                                "a virtual path of GDAL", "a file on this machine");
    return absolute;
}

} // namespace

GdalScope::GdalScope() {
    [[maybe_unused]] static const bool registered = register_drivers();
    CPLPushErrorHandlerEx(keep, &error_);
    CPLSetThreadLocalConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR");
    CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO");
}

GdalScope::~GdalScope() {
    CPLSetThreadLocalConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", nullptr);
    CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
    CPLPopErrorHandler();
}

std::string GdalScope::error(const char* otherwise) {
    base::refuse_if_starved();
    std::string message = std::exchange(error_, {}).value_or(otherwise);
    // Its messages name the file, some twice, and ours name it too: a long path would push out what
    // they say.
    for (std::size_t at = 0;
         !opened_.empty() && (at = message.find(opened_, at)) != std::string::npos;)
        message.erase(
            at,
            std::min(message.find_first_not_of(": ", at + opened_.size()), message.size()) - at);
    return message.empty() ? otherwise : message;
}

Dataset GdalScope::open_features(const std::filesystem::path& path, const char* const* drivers) {
    return Dataset(GDALOpenEx(plain_path(path).c_str(),
                              GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_INTERNAL, drivers,
                              nullptr, nullptr));
}

Dataset GdalScope::open(const std::filesystem::path& path, const char* const* drivers) {
    const std::string absolute = plain_path(path);
    // The one side file that is read, an ASCII grid's CRS, by a driver that would wait on a FIFO.
    for (const char* extension : {".prj", ".PRJ"})
        if (const auto side = std::filesystem::path(absolute).replace_extension(extension);
            std::filesystem::exists(side))
            static_cast<void>(base::read_text(side, kMostCrsBytes));
    opened_ = absolute;
    return Dataset(GDALOpenEx(absolute.c_str(),
                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_INTERNAL, drivers,
                              nullptr, nullptr));
}

void GdalScope::read(GDALRasterBandH band, const std::filesystem::path& path,
                     std::vector<float>& values) {
    const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
    const std::int64_t pixels = std::int64_t{width} * height;
    // A block may claim to be far larger than the raster, and is read whole.
    int block_width = 0, block_height = 0;
    GDALGetBlockSize(band, &block_width, &block_height);
    if (std::int64_t{block_width} * block_height > std::max<std::int64_t>(pixels, 1 << 22))
        throw base::input_error(base::ExitCode::kOverLimit, path, 0, "block",
                                fmt::format("{} x {}", block_width, block_height),
                                "no more than the raster");
    values.resize(static_cast<std::size_t>(pixels));
    if (GDALRasterIO(band, GF_Read, 0, 0, width, height, values.data(), width, height, GDT_Float32,
                     0, 0) != CE_None)
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "cannot decode",
                                error("broken data"), "a whole picture");
    if (is_signed_byte(band))
        for (float& value : values)
            value -= value > 127 ? 256.0f : 0.0f;
}

std::vector<std::uint8_t> GdalScope::read_valid(GDALRasterBandH band,
                                                const std::filesystem::path& path,
                                                const std::vector<float>& values) {
    std::vector<std::uint8_t> valid;
    if (GDALGetMaskFlags(band) != GMF_ALL_VALID) {
        const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
        valid.resize(values.size());
        if (GDALRasterIO(GDALGetMaskBand(band), GF_Read, 0, 0, width, height, valid.data(), width,
                         height, GDT_Byte, 0, 0) != CE_None)
            throw base::input_error(base::ExitCode::kBadInput, path, 0, "cannot decode the mask",
                                    error("broken data"), "a whole mask");
    }
    // GDAL heeds an alpha of 8 or 16 bits unsigned only.
    GDALDatasetH dataset = GDALGetBandDataset(band);
    for (int n = 1; valid.empty() && dataset && n <= GDALGetRasterCount(dataset); ++n)
        if (GDALRasterBandH alpha = GDALGetRasterBand(dataset, n);
            alpha != band && GDALGetRasterColorInterpretation(alpha) == GCI_AlphaBand) {
            std::vector<float> opacity;
            read(alpha, path, opacity);
            valid.resize(values.size());
            std::transform(opacity.begin(), opacity.end(), valid.begin(),
                           [](float a) { return static_cast<std::uint8_t>(a > 0 ? 255 : 0); });
        }
    // A mask inside the file hides the number from GDAL; it holds all the same.
    int has_nodata = 0;
    const auto nodata = static_cast<float>(GDALGetRasterNoDataValue(band, &has_nodata));
    if (has_nodata) {
        valid.resize(values.size(), 255);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (values[i] == nodata)
                valid[i] = 0;
    }
    return valid;
}

GDALRasterBandH choose_band(GDALDatasetH dataset, const std::filesystem::path& path, int number,
                            const char* what) {
    const int bands = GDALGetRasterCount(dataset);
    const auto is_alpha = [&](int n) {
        return GDALGetRasterColorInterpretation(GDALGetRasterBand(dataset, n)) == GCI_AlphaBand;
    };
    std::array<double, 6> affine{};
    const int most =
        GDALGetGeoTransform(dataset, affine.data()) == CE_None ? kMostBands : kMostChannels;
    if (bands > most)
        throw base::input_error(base::ExitCode::kOverLimit, path, 0, "channels",
                                std::to_string(bands), fmt::format("at most {}", most));
    if (number > bands || bands < 1)
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "bands", std::to_string(bands),
                                fmt::format("a band {}", std::max(number, 1)));
    if (number == 0 && bands > 1 && !(bands == 2 && is_alpha(2)))
        base::log_warning(fmt::format("{}: {} bands; the first is the {}",
                                      base::printable(path.native(), 1024), bands, what));
    return GDALGetRasterBand(dataset, std::max(number, 1));
}

bool is_signed_byte(GDALRasterBandH band) {
    const char* type = GDALGetMetadataItem(band, "PIXELTYPE", "IMAGE_STRUCTURE");
    return GDALGetRasterDataType(band) == GDT_Byte && type &&
           std::string_view(type) == "SIGNEDBYTE";
}

const char* type_name(GDALRasterBandH band) {
    return is_signed_byte(band) ? "Int8" : GDALGetDataTypeName(GDALGetRasterDataType(band));
}

double full_scale_of(GDALRasterBandH band) {
    const GDALDataType type = GDALGetRasterDataType(band);
    if ((type != GDT_Byte && type != GDT_UInt16) || is_signed_byte(band))
        return 0;
    const int whole = type == GDT_Byte ? 8 : 16;
    const char* bits = GDALGetMetadataItem(band, "NBITS", "IMAGE_STRUCTURE");
    const int count = bits ? std::atoi(bits) : whole;
    return double((1 << (count >= 1 && count < whole ? count : whole)) - 1);
}

} // namespace sward::assets
