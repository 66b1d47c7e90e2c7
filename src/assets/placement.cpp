// SPDX-License-Identifier: Apache-2.0
#include "assets/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "assets/assets.h"
#include "assets/gdal_scope.h"
#include "assets/place_finder.h"
#include "base/angles.h"
#include "base/error.h"
#include "base/room.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

constexpr int kCell = 16;             // points between exact transformations
constexpr double kLinearError = 0.02; // posts, in the middle of such a cell
constexpr double kSeam =
    1000; // posts between neighbours: the two ends of a raster that goes around the Earth

base::Error bad(const fs::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    base::refuse_if_starved(); // PROJ without its database knows no CRS
    return base::input_error(base::ExitCode::kBadInput, path, 0, what, found, expected);
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

/// Takes over a reference, with x east and y north whatever its authority says.
Reference own(OGRSpatialReferenceH srs) {
    Reference reference(srs);
    if (reference)
        OSRSetAxisMappingStrategy(srs, OAMS_TRADITIONAL_GIS_ORDER);
    return reference;
}

Reference wgs84() {
    Reference reference = own(OSRNewSpatialReference(nullptr));
    OSRImportFromEPSG(handle(reference), 4326);
    return reference;
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

double degrees_per_unit(const Reference& geographic) {
    return OSRGetAngularUnits(handle(geographic), nullptr) / base::kDegree;
}

std::string wkt_of(const Reference& reference) {
    char* text = nullptr;
    const std::array<const char*, 2> options = {"FORMAT=WKT2_2019", nullptr};
    const bool done =
        OSRExportToWktEx(handle(reference), &text, options.data()) == OGRERR_NONE && text;
    std::string wkt = done ? text : "";
    CPLFree(text);
    return wkt;
}

/// After how many units x comes back to the same meridian: rasters across 180 degrees, or of
/// longitudes from 0 to 360, go on past where a projection's own numbers end. 0: it never does.
double period_of(const Reference& source, const Reference& geographic) {
    if (OSRIsGeographic(handle(source)))
        return 360 / degrees_per_unit(source);
    const char* projection = OSRGetAttrValue(handle(source), "PROJECTION", 0);
    constexpr std::array<std::string_view, 5> kCylinders = {
        "Mercator_1SP", "Mercator_2SP", "Equirectangular", "Cylindrical_Equal_Area",
        "Miller_Cylindrical"};
    if (!projection || std::find(kCylinders.begin(), kCylinders.end(),
                                 std::string_view(projection)) == kCylinders.end())
        return 0;
    // Two meridians a few degrees apart, on the equator and far from the seam.
    const double unit = degrees_per_unit(geographic);
    const double middle = OSRGetNormProjParm(handle(source), "central_meridian", 0, nullptr);
    std::vector<glm::dvec2> points = {{(middle - 5) / unit, 0}, {(middle + 5) / unit, 0}};
    if (const Transformation to_map = between(geographic, source))
        transform(to_map, points);
    const double period = std::abs(points[1].x - points[0].x) * 36;
    return std::isfinite(period) ? period : 0;
}

class GdalPlacement : public Placement {
public:
    GdalPlacement(const std::array<double, 6>& affine, Reference source, glm::ivec2 size,
                  const fs::path& path)
        : affine_(affine), source_(std::move(source)), path_(path) {
        std::array<double, 6> values = affine;
        if (GDALInvGeoTransform(values.data(), inverse_.data()) == 0 || !std::isfinite(inverse_[1]))
            throw bad(path, "geotransform", fmt::format("{}", fmt::join(affine, ", ")),
                      "a scale that is not zero");
        geographic_ = own(OSRCloneGeogCS(handle(source_)));
        if (!geographic_)
            throw bad(path, "CRS", "no geographic datum", "a geographic or projected CRS");
        middle_ = on_map(glm::dvec2(size - 1) / 2.0);
        period_ = period_of(source_, geographic_);
    }

    /// A frame about the raster's own middle.
    void use_own_frame() {
        std::vector<glm::dvec2> middle = {middle_};
        if (const Transformation to_angles = between(source_, geographic_))
            transform(to_angles, middle);
        const glm::dvec2 centre = middle[0] * degrees_per_unit(geographic_);
        if (!(std::abs(centre.x) <= 540 && std::abs(centre.y) <= 90)) // NaN too
            throw bad(path_, "place on Earth",
                      fmt::format("longitude {}, latitude {}", centre.x, centre.y),
                      "a raster whose middle lies on Earth");
        const double longitude = std::remainder(centre.x, 360.0);
        Reference local = own(OSRClone(handle(geographic_)));
        OSRSetProjCS(handle(local), "local");
        OSRSetAE(handle(local), centre.y, longitude, 0, 0);
        OSRSetLinearUnits(handle(local), SRS_UL_METER, 1);
        OSRSetAxisMappingStrategy(handle(local), OAMS_TRADITIONAL_GIS_ORDER);
        std::vector<glm::dvec2> point = {middle[0]};
        if (const Transformation to_wgs84 = between(geographic_, wgs84()))
            transform(to_wgs84, point);
        const glm::dvec2 place =
            std::isfinite(point[0].x) ? point[0] : centre; // a datum PROJ has no grid for
        frame_.latitude_deg = place.y;
        frame_.longitude_deg = std::remainder(place.x, 360.0);
        frame_.crs = wkt_of(local);
        frame_.source = base::printable(OSRGetName(handle(source_)));
        connect(local);
    }
    void use_frame(const scene::Georeference& frame) {
        frame_ = frame;
        if (frame.crs.empty()) {
            connect(wgs84());
            return;
        }
        Reference local = own(OSRNewSpatialReference(nullptr));
        char* text = frame_.crs.data();
        if (OSRImportFromWkt(handle(local), &text) != OGRERR_NONE)
            throw bad(path_, "frame of the terrain", "a CRS that cannot be read back",
                      "one that can");
        connect(local);
    }

    void posts_to_metres(std::vector<glm::dvec2>& points) const override {
        for (glm::dvec2& p : points)
            p = on_map(p);
        transform(to_local_, points);
        if (frame_.crs.empty())
            for (glm::dvec2& p : points)
                p = glm::dvec2(1, -1) * scene::linear_place(frame_, p.y, p.x);
    }
    void metres_to_posts(std::vector<glm::dvec2>& points) const override {
        if (frame_.crs.empty())
            for (glm::dvec2& p : points)
                p = glm::dvec2(frame_.longitude_deg, frame_.latitude_deg) +
                    p / frame_.metres_per_degree;
        transform(to_source_, points);
        for (glm::dvec2& p : points) {
            if (period_ > 0)
                p.x += period_ * std::round((middle_.x - p.x) / period_); // NaN stays NaN
            p = apply(inverse_, p) - 0.5;
        }
    }
    [[nodiscard]] const scene::Georeference& frame() const override { return frame_; }

private:
    static glm::dvec2 apply(const std::array<double, 6>& a, glm::dvec2 p) {
        return {a[0] + a[1] * p.x + a[2] * p.y, a[3] + a[4] * p.x + a[5] * p.y};
    }
    /// A post stands in the middle of its cell.
    [[nodiscard]] glm::dvec2 on_map(glm::dvec2 post) const { return apply(affine_, post + 0.5); }

    void connect(const Reference& local) {
        to_local_ = between(source_, local);
        to_source_ = between(local, source_);
        if (!to_local_ || !to_source_)
            throw bad(path_, "CRS", "no way to metres", "a geographic or projected CRS");
    }

    std::array<double, 6> affine_, inverse_{};
    Reference source_, geographic_;
    fs::path path_;
    glm::dvec2 middle_{0};
    double period_ = 0;
    Transformation to_local_, to_source_;
    scene::Georeference frame_;
};

} // namespace

scene::PlaceOnEarth place_finder(const scene::Georeference& frame) {
    if (frame.crs.empty())
        return [frame](double latitude_deg, double longitude_deg) {
            return scene::linear_place(frame, latitude_deg, longitude_deg);
        };
    const GdalScope silence;
    Reference local = own(OSRNewSpatialReference(nullptr));
    std::string wkt = frame.crs;
    char* text = wkt.data();
    auto to_local = std::make_shared<Transformation>(); // costs milliseconds, a place microseconds
    if (OSRImportFromWkt(handle(local), &text) == OGRERR_NONE)
        *to_local = between(wgs84(), local);
    return [to_local](double latitude_deg, double longitude_deg) {
        const GdalScope quiet;
        std::vector<glm::dvec2> point = {{std::remainder(longitude_deg, 360.0), latitude_deg}};
        if (*to_local)
            transform(*to_local, point);
        if (!*to_local || !std::isfinite(point[0].x + point[0].y))
            throw base::Error(base::ExitCode::kBadInput,
                              fmt::format("geo: found latitude {}, longitude {}, expected a place "
                                          "that the terrain's frame can hold",
                                          latitude_deg, longitude_deg));
        return glm::dvec2(point[0].x, -point[0].y);
    };
}

glm::dvec2 local_place(const scene::Georeference& frame, double latitude_deg,
                       double longitude_deg) {
    return place_finder(frame)(latitude_deg, longitude_deg);
}

std::unique_ptr<Placement> place_raster(GDALDatasetH dataset, const fs::path& path,
                                        const scene::Georeference* frame) {
    std::array<double, 6> affine{};
    OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset);
    if (!srs)
        base::refuse_if_starved(); // a reference that cannot be looked up is none to GDAL
    if (!srs || GDALGetGeoTransform(dataset, affine.data()) != CE_None || OSRIsLocal(srs))
        return nullptr;
    if (!OSRIsGeographic(srs) && !OSRIsProjected(srs))
        throw bad(path, "CRS", base::printable(OSRGetName(srs)), "a geographic or projected CRS");
    auto placement = std::make_unique<GdalPlacement>(
        affine, own(OSRClone(srs)),
        glm::ivec2(GDALGetRasterXSize(dataset), GDALGetRasterYSize(dataset)), path);
    if (frame)
        placement->use_frame(*frame);
    else
        placement->use_own_frame();
    return placement;
}

FrameWarp warp_to_frame(void* srs, const scene::Georeference& frame, const fs::path& path) {
    if (!srs)
        throw bad(path, "CRS", "none", "one that says where on Earth it lies");
    const Reference source = own(OSRClone(static_cast<OGRSpatialReferenceH>(srs)));
    Reference local;
    if (frame.crs.empty()) {
        local = wgs84();
    } else {
        local = own(OSRNewSpatialReference(nullptr));
        std::string wkt = frame.crs;
        char* text = wkt.data();
        if (OSRImportFromWkt(handle(local), &text) != OGRERR_NONE)
            throw bad(path, "CRS of the terrain", "one that PROJ cannot read", "one that it knows");
    }
    auto way = std::make_shared<Transformation>(between(source, local));
    if (!*way)
        throw bad(path, "CRS", base::printable(OSRGetName(handle(source))),
                  "one with a way to the terrain's");
    return [way, frame](std::vector<glm::dvec2>& points) {
        transform(*way, points);
        for (glm::dvec2& p : points)
            p = frame.crs.empty() ? scene::linear_place(frame, p.y, p.x) : glm::dvec2(p.x, -p.y);
    };
}

std::optional<glm::dvec2> bare_spacing(GDALDatasetH dataset) {
    std::array<double, 6> affine{};
    OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset);
    if (!srs || !OSRIsLocal(srs) || GDALGetGeoTransform(dataset, affine.data()) != CE_None)
        return std::nullopt;
    const double unit = OSRGetLinearUnits(srs, nullptr);
    const glm::dvec2 spacing = glm::dvec2(affine[1], -affine[5]) * unit;
    const bool upright = affine[2] == 0 && affine[4] == 0 && spacing.x > 0 && spacing.y > 0;
    return upright && std::isfinite(spacing.x + spacing.y) ? std::optional(spacing) : std::nullopt;
}

std::vector<glm::dvec2> outline(glm::dvec2 low, glm::dvec2 high, int points) {
    std::vector<glm::dvec2> around;
    for (int i = 0; i <= points; ++i) {
        const glm::dvec2 p = glm::mix(low, high, double(i) / points);
        for (const glm::dvec2 q : {glm::dvec2(p.x, low.y), glm::dvec2(p.x, high.y),
                                   glm::dvec2(low.x, p.y), glm::dvec2(high.x, p.y)})
            around.push_back(q);
    }
    return around;
}

PostGrid::PostGrid(const Placement& placement, glm::dvec2 first, glm::dvec2 step, glm::ivec2 points)
    : columns_((points.x - 1) / kCell + 2), rows_((points.y - 1) / kCell + 2) {
    posts_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (int j = 0; j < rows_; ++j)
        for (int i = 0; i < columns_; ++i) {
            const glm::dvec2 place = first + glm::dvec2(i, j) * double(kCell) * step;
            posts_.emplace_back(place.x, -place.y); // north is up
        }
    placement.metres_to_posts(posts_);
    refine(placement, first, step);
}

void PostGrid::refine(const Placement& placement, glm::dvec2 first, glm::dvec2 step) {
    const auto place = [&](double i, double j) {
        const glm::dvec2 at = first + glm::dvec2(i, j) * step;
        return glm::dvec2(at.x, -at.y);
    };
    std::vector<glm::dvec2> middles;
    for (int j = 0; j + 1 < rows_; ++j)
        for (int i = 0; i + 1 < columns_; ++i)
            middles.push_back(place((i + 0.5) * kCell, (j + 0.5) * kCell));
    placement.metres_to_posts(middles);
    std::size_t middle = 0;
    for (int j = 0; j + 1 < rows_; ++j)
        for (int i = 0; i + 1 < columns_; ++i) {
            const glm::dvec2 guess = at((i + 0.5) * kCell, (j + 0.5) * kCell),
                             truth = middles[middle++];
            const bool known = std::isfinite(guess.x + guess.y) || std::isfinite(truth.x + truth.y);
            if (!known || glm::length(guess - truth) < kLinearError)
                continue;
            std::vector<glm::dvec2> points;
            for (int v = 0; v <= kCell; ++v)
                for (int u = 0; u <= kCell; ++u)
                    points.push_back(place(i * kCell + u, j * kCell + v));
            placement.metres_to_posts(points);
            exact_.emplace(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(i),
                           std::move(points));
        }
}

glm::dvec2 PostGrid::at(double i, double j) const {
    const glm::dvec2 place = glm::dvec2(i, j) / double(kCell);
    const glm::ivec2 cell = glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(0),
                                       glm::ivec2(columns_ - 2, rows_ - 2));
    const std::size_t index =
        static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(columns_) +
        static_cast<std::size_t>(cell.x);
    glm::dvec2 f = place - glm::dvec2(cell);
    const glm::dvec2* p = &posts_[index];
    std::size_t row = static_cast<std::size_t>(columns_);
    const auto exact = exact_.empty() ? exact_.end() : exact_.find(index);
    if (exact != exact_.end()) {
        const glm::dvec2 inside = f * double(kCell);
        const glm::ivec2 point =
            glm::clamp(glm::ivec2(glm::floor(inside)), glm::ivec2(0), glm::ivec2(kCell - 1));
        f = inside - glm::dvec2(point);
        row = kCell + 1;
        p = &exact->second[static_cast<std::size_t>(point.y) * row +
                           static_cast<std::size_t>(point.x)];
        if (!(glm::length(p[0] - p[row + 1]) < kSeam && glm::length(p[1] - p[row]) < kSeam))
            return p[(f.y < 0.5 ? 0 : row) + (f.x < 0.5 ? 0 : 1)];
    }
    return glm::mix(glm::mix(p[0], p[1], f.x), glm::mix(p[row], p[row + 1], f.x), f.y);
}

} // namespace sward::assets
