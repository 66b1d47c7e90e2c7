// SPDX-License-Identifier: Apache-2.0
#include "assets/gdal_raster.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "assets/gdal_scope.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/log.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr double kHighest_m =
    1e5; // and the lowest, negated: anything past it is no height on Earth
constexpr std::int16_t kSrtmVoid = -32768;
// They read one file and follow nothing in it. VRT, HFA, WMS and their like may name other files
// and hosts.
constexpr std::array<const char*, 5> kDrivers = {"GTiff", "AAIGrid", "DTED", "USGSDEM", nullptr};

base::Error bad(const fs::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    return base::input_error(ExitCode::kBadInput, path, 0, what, found, expected);
}

struct FreeReference {
    void operator()(void* srs) const {
        OSRDestroySpatialReference(static_cast<OGRSpatialReferenceH>(srs));
    }
};
struct FreeTransformation {
    void operator()(void* ct) const {
        OCTDestroyCoordinateTransformation(static_cast<OGRCoordinateTransformationH>(ct));
    }
};
using Reference = std::unique_ptr<void, FreeReference>;
using Transformation = std::unique_ptr<void, FreeTransformation>;

OGRSpatialReferenceH handle(const Reference& reference) {
    return static_cast<OGRSpatialReferenceH>(reference.get());
}

void transform(const Transformation& transformation, std::vector<glm::dvec2>& points) {
    std::vector<double> x, y;
    for (const glm::dvec2& p : points)
        x.push_back(p.x), y.push_back(p.y);
    std::vector<int> reached(points.size(), 0);
    OCTTransformEx(static_cast<OGRCoordinateTransformationH>(transformation.get()),
                   static_cast<int>(points.size()), x.data(), y.data(), nullptr, reached.data());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = reached[i] && std::isfinite(x[i]) && std::isfinite(y[i])
                        ? glm::dvec2(x[i], y[i])
                        : glm::dvec2(NAN, NAN);
}

Transformation between(const Reference& from, const Reference& to) {
    return Transformation(OCTNewCoordinateTransformation(handle(from), handle(to)));
}

class GdalPlacement : public Placement {
public:
    GdalPlacement(const std::array<double, 6>& affine, const Reference& source, glm::ivec2 size,
                  const fs::path& path)
        : affine_(affine) {
        std::array<double, 6> values = affine;
        if (GDALInvGeoTransform(values.data(), inverse_.data()) == 0 || !std::isfinite(inverse_[1]))
            throw bad(path, "geotransform", fmt::format("{}", fmt::join(affine, ", ")),
                      "a scale that is not zero");
        const Reference geographic(OSRCloneGeogCS(handle(source)));
        if (!geographic)
            throw bad(path, "CRS", "no geographic datum", "a geographic or projected CRS");
        OSRSetAxisMappingStrategy(handle(geographic), OAMS_TRADITIONAL_GIS_ORDER);
        std::vector<glm::dvec2> middle = {on_map(glm::dvec2(size - 1) / 2.0)};
        if (const Transformation to_angles = between(source, geographic))
            transform(to_angles, middle);
        const double degrees =
            OSRGetAngularUnits(handle(geographic), nullptr) * 180 / std::numbers::pi;
        const glm::dvec2 centre = middle[0] * degrees;
        if (!(std::abs(centre.x) <= 540 && std::abs(centre.y) <= 90)) // NaN too
            throw bad(path, "place on Earth",
                      fmt::format("longitude {}, latitude {}", centre.x, centre.y),
                      "a raster whose middle lies on Earth");

        const Reference local(OSRClone(handle(geographic)));
        OSRSetProjCS(handle(local), "local");
        OSRSetAE(handle(local), centre.y, centre.x, 0, 0);
        OSRSetLinearUnits(handle(local), SRS_UL_METER, 1);
        OSRSetAxisMappingStrategy(handle(local), OAMS_TRADITIONAL_GIS_ORDER);
        to_local_ = between(source, local);
        to_source_ = between(local, source);
        if (!to_local_ || !to_source_)
            throw bad(path, "CRS", "no way to metres", "a geographic or projected CRS");
        set_middle(geographic, middle[0], centre);
    }

    void posts_to_metres(std::vector<glm::dvec2>& points) const override {
        for (glm::dvec2& p : points)
            p = on_map(p);
        transform(to_local_, points);
    }
    void metres_to_posts(std::vector<glm::dvec2>& points) const override {
        transform(to_source_, points);
        for (glm::dvec2& p : points)
            p = apply(inverse_, p) - 0.5;
    }
    [[nodiscard]] scene::Georeference middle() const override { return middle_; }

private:
    static glm::dvec2 apply(const std::array<double, 6>& a, glm::dvec2 p) {
        return {a[0] + a[1] * p.x + a[2] * p.y, a[3] + a[4] * p.x + a[5] * p.y};
    }
    /// A post stands in the middle of its cell.
    [[nodiscard]] glm::dvec2 on_map(glm::dvec2 post) const { return apply(affine_, post + 0.5); }

    void set_middle(const Reference& geographic, glm::dvec2 angles, glm::dvec2 degrees) {
        const Reference wgs84(OSRNewSpatialReference(nullptr));
        OSRImportFromEPSG(handle(wgs84), 4326);
        OSRSetAxisMappingStrategy(handle(wgs84), OAMS_TRADITIONAL_GIS_ORDER);
        std::vector<glm::dvec2> point = {angles};
        if (const Transformation to_wgs84 = between(geographic, wgs84))
            transform(to_wgs84, point);
        const glm::dvec2 place =
            std::isfinite(point[0].x) ? point[0] : degrees; // a datum PROJ has no grid for
        middle_ = {place.y, place.x};
    }

    std::array<double, 6> affine_, inverse_{};
    Transformation to_local_, to_source_;
    scene::Georeference middle_;
};

/// Factor that turns the band's unit into metres.
double unit_of(GDALRasterBandH band, const fs::path& path, bool& has_unit) {
    const std::string unit = GDALGetRasterUnitType(band);
    has_unit = !unit.empty();
    for (const char* name : {"", "m", "metre", "meter", "metres", "meters"})
        if (unit == name)
            return 1;
    for (const char* name : {"ft", "foot", "feet", "Foot"})
        if (unit == name)
            return 0.3048;
    for (const char* name : {"sfeet", "us-ft", "US survey foot"})
        if (unit == name)
            return 1200.0 / 3937.0;
    throw bad(path, "unit of the heights", base::printable(unit), "metres or feet");
}

/// Voids become NaN, the rest metres; anything else that is not a height is refused.
void to_metres(GDALRasterBandH band, const fs::path& path, Raster& raster) {
    int has_nodata = 0, has_scale = 0, has_offset = 0;
    const double nodata = GDALGetRasterNoDataValue(band, &has_nodata);
    double scale = GDALGetRasterScale(band, &has_scale),
           offset = GDALGetRasterOffset(band, &has_offset);
    scale = has_scale ? scale : 1;
    offset = has_offset ? offset : 0;
    if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset))
        throw bad(path, "scale of the heights", fmt::format("{} and offset {}", scale, offset),
                  "a scale that is not zero");
    const double unit = unit_of(band, path, raster.has_unit);
    raster.has_unit |= scale != 1 || offset != 0;
    const bool srtm = GDALGetRasterDataType(band) == GDT_Int16;
    for (std::size_t i = 0; i < raster.values.size(); ++i) {
        float& value = raster.values[i];
        const bool is_void = (has_nodata && (value == static_cast<float>(nodata) ||
                                             (std::isnan(nodata) && std::isnan(value)))) ||
                             (srtm && value == kSrtmVoid);
        const double metres = (double(value) * scale + offset) * unit;
        if (!is_void && !(std::abs(metres) <= kHighest_m))
            throw bad(
                path,
                fmt::format("height at column {}, row {}", i % raster.width, i / raster.width),
                fmt::format("{} m", metres), fmt::format("-{0} to {0} m", kHighest_m));
        value = is_void ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(metres);
    }
}

void read_band(const Dataset& dataset, const fs::path& path, std::uint64_t file_bytes,
               GdalScope& gdal, Raster& raster) {
    const int bands = GDALGetRasterCount(dataset.get());
    GDALRasterBandH band = bands > 0 ? GDALGetRasterBand(dataset.get(), 1) : nullptr;
    if (!band)
        throw bad(path, "bands", "none", "one band of heights");
    raster.width = GDALGetRasterXSize(dataset.get());
    raster.height = GDALGetRasterYSize(dataset.get());
    check_size(path, raster.width, raster.height, bands, sizeof(float), file_bytes, 2);
    if (bands > 1)
        base::log_warning(
            fmt::format("{}: {} bands; the first is the height", path.string(), bands));
    const GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsComplex(type))
        throw bad(path, "type of the heights", GDALGetDataTypeName(type), "real numbers");
    raster.full_scale = type == GDT_Byte ? 255 : type == GDT_UInt16 ? 65535 : 0;
    gdal.read(band, path, raster.values);
    to_metres(band, path, raster);
}

} // namespace

Raster read_gdal_raster(const fs::path& path) {
    GdalScope gdal;
    const Dataset dataset = gdal.open(path, kDrivers.data());
    if (!dataset)
        throw bad(path, "cannot read elevation", gdal.error("an unknown format"),
                  "GeoTIFF, .hgt, Arc/Info ASCII grid, DTED, USGS DEM, 16-bit PNG or EXR");
    Raster raster;
    read_band(dataset, path, fs::file_size(path), gdal, raster);

    std::array<double, 6> affine{};
    OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset.get());
    const bool placed = GDALGetGeoTransform(dataset.get(), affine.data()) == CE_None;
    if (!srs || !placed)
        return raster;
    const Reference source(OSRClone(srs));
    if (!OSRIsGeographic(handle(source)) && !OSRIsProjected(handle(source)))
        throw bad(path, "CRS", base::printable(OSRGetName(handle(source))),
                  "a geographic or projected CRS");
    OSRSetAxisMappingStrategy(handle(source), OAMS_TRADITIONAL_GIS_ORDER);
    raster.placement = std::make_unique<GdalPlacement>(
        affine, source, glm::ivec2(raster.width, raster.height), path);
    return raster;
}

std::string gdal_versions() {
    int major = 0, minor = 0, patch = 0;
    OSRGetPROJVersion(&major, &minor, &patch);
    return fmt::format("GDAL {}, PROJ {}.{}.{}", GDALVersionInfo("RELEASE_NAME"), major, minor,
                       patch);
}

} // namespace sward::assets
