// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"

using GDALDatasetH = void*; // as gdal.h has it, which those who include this need not have

namespace sward::assets {

/// Where a raster lies: between its posts (column, row; post (0, 0) is the middle of the first
/// cell) and metres east and north in a local frame. Points that have no image become NaN. Posts
/// beyond the raster have an image too, where the Earth has one.
class Placement {
public:
    virtual ~Placement() = default;
    virtual void posts_to_metres(std::vector<glm::dvec2>& points) const = 0;
    virtual void metres_to_posts(std::vector<glm::dvec2>& points) const = 0;
    [[nodiscard]] virtual const scene::Georeference& frame() const = 0;
};

/// The placement of an open raster in `frame`, or, where that is null, in a frame of its own:
/// azimuthal equidistant about the raster's middle, on its datum. Null where the file has no place
/// on Earth: no CRS, no geotransform, or the coordinates of a building site. Throws
/// base::Error(kBadInput) naming `path`.
[[nodiscard]] std::unique_ptr<Placement> place_raster(GDALDatasetH dataset,
                                                      const std::filesystem::path& path,
                                                      const scene::Georeference* frame);

/// Points in a file's CRS, x east and y north, to x and z of a frame (m); NaN where they have no
/// image.
using FrameWarp = std::function<void(std::vector<glm::dvec2>&)>;
/// `srs`: an OGRSpatialReferenceH, which it copies. Throws base::Error(kBadInput) naming `path`
/// where there is none, or no way.
[[nodiscard]] FrameWarp warp_to_frame(void* srs, const scene::Georeference& frame,
                                      const std::filesystem::path& path);

/// Metres a post of a raster that is measured in metres (or feet) without a place on Earth:
/// upright, or nothing.
[[nodiscard]] std::optional<glm::dvec2> bare_spacing(GDALDatasetH dataset);

/// The corners and the outline of a raster of `size` posts: `points` a side, all around, as posts.
[[nodiscard]] std::vector<glm::dvec2> outline(glm::dvec2 low, glm::dvec2 high, int points);

/// Posts of a raster under the points of a regular grid in the frame: exact at every 16th point and
/// linear between them, where that errs by under a fiftieth of a post; exact at every point
/// elsewhere (near a pole, across a seam of longitudes).
class PostGrid {
public:
    /// `first`: x, z of point (0, 0); `step`: from point to point, z to the south.
    PostGrid(const Placement& placement, glm::dvec2 first, glm::dvec2 step, glm::ivec2 points);
    /// The post under point (i, j), which may lie between points; NaN where there is none.
    [[nodiscard]] glm::dvec2 at(double i, double j) const;

private:
    void refine(const Placement& placement, glm::dvec2 first, glm::dvec2 step);
    int columns_ = 0, rows_ = 0;
    std::vector<glm::dvec2> posts_;
    std::unordered_map<std::size_t, std::vector<glm::dvec2>>
        exact_; ///< by cell: every point of it, both ends included
};

} // namespace sward::assets
