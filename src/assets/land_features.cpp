// SPDX-License-Identifier: Apache-2.0
#include "assets/land_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>

#include "assets/gdal_scope.h"
#include "assets/placement.h"
#include "assets/sqlite_budget.h"
#include "base/error.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;
constexpr std::size_t kMostVertices = 4000000;
constexpr int kDeepest = 8; // collections within collections
constexpr int kBandRows = 32;
constexpr int kScanlines = 4; // of an area in a row of texels; along a row it is exact

struct FreeFeature {
    void operator()(void* feature) const { OGR_F_Destroy(static_cast<OGRFeatureH>(feature)); }
};
using Feature = std::unique_ptr<void, FreeFeature>;

/// Takes up what a file's geometries hold.
class Collector {
public:
    Collector(const scene::LandFeature& feature, LandShapes& shapes)
        : feature_(feature), shapes_(shapes) {}

    void add(OGRGeometryH geometry, int depth = 0) {
        if (!geometry || depth > kDeepest)
            return;
        const bool lines = feature_.width_m > 0;
        switch (wkbFlatten(OGR_G_GetGeometryType(geometry))) {
        case wkbLineString:
            if (lines)
                add_ring(geometry, shapes_.lines);
            break;
        case wkbPolygon:
            if (!lines) {
                shapes_.areas.emplace_back();
                for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i)
                    add_ring(OGR_G_GetGeometryRef(geometry, i), shapes_.areas.back());
            }
            break;
        case wkbMultiLineString:
        case wkbMultiPolygon:
        case wkbGeometryCollection:
            for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i)
                add(OGR_G_GetGeometryRef(geometry, i), depth + 1);
            break;
        default:
            break; // points, curves, surfaces
        }
    }

private:
    void add_ring(OGRGeometryH ring, std::vector<LandShapes::Ring>& rings) {
        const int count = OGR_G_GetPointCount(ring);
        vertices_ += static_cast<std::size_t>(std::max(count, 0));
        if (vertices_ > kMostVertices)
            throw base::input_error(ExitCode::kOverLimit, feature_.file, 0, "vertices",
                                    fmt::format("more than {}", kMostVertices),
                                    fmt::format("at most {}", kMostVertices));
        LandShapes::Ring points;
        for (int i = 0; i < count; ++i)
            points.emplace_back(OGR_G_GetX(ring, i), OGR_G_GetY(ring, i));
        if (points.size() > 1)
            rings.push_back(std::move(points));
    }

    const scene::LandFeature& feature_;
    LandShapes& shapes_;
    std::size_t vertices_ = 0;
};

void refuse_large(const fs::path& path) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        throw base::input_error(ExitCode::kIo, path, 0, "cannot read", error.message(), "a file");
    if (size > kMostBytes)
        throw base::input_error(ExitCode::kOverLimit, path, 0, "size",
                                fmt::format("{} bytes", size),
                                fmt::format("at most {}", kMostBytes));
}

/// A database whose queries never end.
void refuse_spent(const SqliteBudget& budget, const fs::path& path) {
    if (budget.spent())
        throw base::input_error(ExitCode::kOverLimit, path, 0, "database",
                                "queries of more than 50 million steps",
                                "tables of areas or lines");
}

OGRLayerH layer_of(GDALDatasetH dataset, const scene::LandFeature& feature) {
    const OGRLayerH layer = feature.layer.empty()
                                ? GDALDatasetGetLayer(dataset, 0)
                                : GDALDatasetGetLayerByName(dataset, feature.layer.c_str());
    if (!layer)
        throw base::input_error(
            ExitCode::kBadInput, feature.file, 0, "layer",
            feature.layer.empty() ? "none" : "no \"" + base::printable(feature.layer) + "\"",
            "one of its layers");
    return layer;
}

void warp(const FrameWarp& to_frame, const fs::path& path, std::vector<LandShapes::Ring>& rings) {
    for (LandShapes::Ring& ring : rings) {
        to_frame(ring);
        for (const glm::dvec2& point : ring)
            if (!std::isfinite(point.x + point.y))
                throw base::input_error(ExitCode::kBadInput, path, 0, "coordinates",
                                        "a place that the terrain's frame cannot hold",
                                        "places near the terrain");
    }
}

} // namespace

LandShapes read_features(const scene::LandFeature& feature, const scene::Heightfield& ground) {
    GdalScope scope;
    const SqliteBudget budget;
    refuse_large(feature.file);
    if (!ground.origin)
        throw base::input_error(ExitCode::kBadInput, feature.file, 0, "terrain",
                                "no place on Earth", "elevation with a CRS under areas and lines");
    static constexpr std::array<const char*, 3> kDrivers = {"GeoJSON", "GPKG", nullptr};
    const Dataset dataset = scope.open_features(feature.file, kDrivers.data());
    refuse_spent(budget, feature.file);
    if (!dataset)
        throw base::input_error(ExitCode::kBadInput, feature.file, 0, "cannot decode",
                                scope.error("another format"), "GeoJSON or GeoPackage");
    const OGRLayerH layer = layer_of(dataset.get(), feature);
    if (!feature.where.empty() &&
        OGR_L_SetAttributeFilter(layer, feature.where.c_str()) != OGRERR_NONE)
        throw base::input_error(ExitCode::kBadInput, feature.file, 0, "where",
                                "\"" + base::printable(feature.where) + "\" (" +
                                    scope.error("refused") + ")",
                                "a condition on the file's attributes");
    const OGRSpatialReferenceH crs =
        OGR_L_GetSpatialRef(layer); // asks what the layer's columns are
    refuse_spent(budget, feature.file);
    const FrameWarp to_frame = warp_to_frame(crs, *ground.origin, feature.file);
    LandShapes shapes;
    Collector collector(feature, shapes);
    static_cast<void>(scope.error("")); // what opening said and went on from
    OGR_L_ResetReading(layer);
    while (const Feature next{OGR_L_GetNextFeature(layer)})
        collector.add(OGR_F_GetGeometryRef(static_cast<OGRFeatureH>(next.get())));
    refuse_spent(budget, feature.file);
    // The last feature and one that cannot be read end the loop alike.
    if (const std::string failure = scope.error(""); !failure.empty())
        throw base::input_error(ExitCode::kBadInput, feature.file, 0, "cannot decode", failure,
                                "whole features");
    if (shapes.lines.empty() && shapes.areas.empty())
        throw base::input_error(ExitCode::kBadInput, feature.file, 0, "geometry",
                                feature.where.empty() ? "none" : "none that \"where\" lets through",
                                feature.width_m > 0 ? "at least one line" : "at least one area");
    warp(to_frame, feature.file, shapes.lines);
    for (std::vector<LandShapes::Ring>& area : shapes.areas)
        warp(to_frame, feature.file, area);
    return shapes;
}

FeatureRows::FeatureRows(LandShapes shapes, double width_m, glm::dvec2 first, glm::dvec2 texel)
    : lines_(width_m > 0), texel_m_(texel), half_m_(width_m / 2) {
    const auto add = [&](glm::dvec2 from, glm::dvec2 to) {
        edges_.push_back({(from - first) / texel, (to - first) / texel});
    };
    for (const LandShapes::Ring& line : shapes.lines)
        for (std::size_t i = 1; i < line.size(); ++i)
            add(line[i - 1], line[i]);
    for (const std::vector<LandShapes::Ring>& area : shapes.areas)
        for (const LandShapes::Ring& ring : area)
            for (std::size_t i = 0; i < ring.size(); ++i)
                add(ring[i], ring[(i + 1) % ring.size()]);
    const double reach = lines_ ? half_m_ / texel.y + 1 : 0;
    constexpr double kMostRows = 1 << 20; // of a grid, and more: what lies beyond is in no row
    for (std::size_t n = 0; n < edges_.size(); ++n) {
        const double low =
            std::clamp(std::min(edges_[n].from.y, edges_[n].to.y) - reach, 0.0, kMostRows);
        const double high =
            std::clamp(std::max(edges_[n].from.y, edges_[n].to.y) + reach, -1.0, kMostRows);
        if (low > high || (low >= kMostRows))
            continue;
        const auto last = static_cast<std::size_t>(high / kBandRows);
        if (by_band_.size() <= last)
            by_band_.resize(last + 1);
        for (auto band = static_cast<std::size_t>(low / kBandRows); band <= last; ++band)
            by_band_[band].push_back(static_cast<int>(n));
    }
}

void FeatureRows::cover(int j, std::vector<float>& shares) const {
    const auto band = static_cast<std::size_t>(j / kBandRows);
    if (band >= by_band_.size())
        return;
    if (lines_)
        cover_lines(j, by_band_[band], shares);
    else
        cover_areas(j, by_band_[band], shares);
}

void FeatureRows::cover_areas(int j, const std::vector<int>& edges,
                              std::vector<float>& shares) const {
    std::vector<double> crossings;
    for (int line = 0; line < kScanlines; ++line) {
        const double y = j + (line + 0.5) / kScanlines;
        crossings.clear();
        for (const int n : edges) {
            const auto& [from, to] = edges_[static_cast<std::size_t>(n)];
            if ((from.y <= y) != (to.y <= y))
                crossings.push_back(from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x));
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            const double low = std::max(crossings[i], 0.0),
                         high = std::min(crossings[i + 1], static_cast<double>(shares.size()));
            for (double x = std::floor(low); x < high; ++x)
                shares[static_cast<std::size_t>(x)] +=
                    static_cast<float>((std::min(high, x + 1) - std::max(low, x)) / kScanlines);
        }
    }
}

void FeatureRows::cover_lines(int j, const std::vector<int>& edges,
                              std::vector<float>& shares) const {
    const double texel = std::min(texel_m_.x, texel_m_.y);
    const double reach = half_m_ + texel;
    const double z = (j + 0.5) * texel_m_.y;
    for (const int n : edges) {
        const glm::dvec2 from = edges_[static_cast<std::size_t>(n)].from * texel_m_,
                         to = edges_[static_cast<std::size_t>(n)].to * texel_m_;
        if (z < std::min(from.y, to.y) - reach || z > std::max(from.y, to.y) + reach)
            continue;
        const glm::dvec2 way = to - from;
        const double square = std::max(glm::dot(way, way), 1e-12);
        // Where the row is near the segment: between the places where it passes at the reach, which
        // a level one never does.
        double low = std::min(from.x, to.x), high = std::max(from.x, to.x);
        if (std::abs(way.y) > 1e-9) {
            const double a = from.x + (z - reach * 1.5 - from.y) / way.y * way.x,
                         b = from.x + (z + reach * 1.5 - from.y) / way.y * way.x;
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        }
        // Aside of a steep one by the reach over the cosine of its lean.
        const double aside =
            reach * std::min(std::sqrt(square) / std::max(std::abs(way.y), 1e-9), 2.0) + reach;
        const auto last = static_cast<double>(shares.size()) - 1;
        for (double i = std::max(std::floor((low - aside) / texel_m_.x), 0.0);
             i <= std::min(std::ceil((high + aside) / texel_m_.x), last); ++i) {
            const glm::dvec2 at((i + 0.5) * texel_m_.x, z);
            const double along = std::clamp(glm::dot(at - from, way) / square, 0.0, 1.0);
            const double share = std::clamp(
                0.5 + (half_m_ - glm::distance(at, from + along * way)) / texel, 0.0, 1.0);
            float& own = shares[static_cast<std::size_t>(i)];
            own = std::max(own, static_cast<float>(share));
        }
    }
}

} // namespace sward::assets
