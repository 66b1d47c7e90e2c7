// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"

namespace sward::assets {

/// Where a raster lies: between its posts (column, row; post (0, 0) is the first) and metres east
/// and north of its middle, on an azimuthal equidistant projection of the raster's own datum.
/// Points that have no image become NaN.
class Placement {
public:
    virtual ~Placement() = default;
    virtual void posts_to_metres(std::vector<glm::dvec2>& points) const = 0;
    virtual void metres_to_posts(std::vector<glm::dvec2>& points) const = 0;
    [[nodiscard]] virtual scene::Georeference middle() const = 0;
};

struct Raster {
    int width = 0;
    int height = 0;
    std::vector<float>
        values; ///< NaN where the file has no value; scale, offset and unit of the file are applied
    double full_scale = 0;                ///< of an unsigned integer type (255, 65535), else 0
    bool has_unit = false;                ///< the file says what its values are: a unit, or a scale
    std::unique_ptr<Placement> placement; ///< null where the file carries no CRS
};

/// The first band of a local elevation file, through the few GDAL drivers that follow no reference
/// to another place. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Raster read_gdal_raster(const std::filesystem::path& path);

/// Versions of GDAL and PROJ.
[[nodiscard]] std::string gdal_versions();

/// The raster on a regular grid of its Placement's metres: the largest rectangle about the middle
/// that the raster covers, at its own spacing, bicubic. Voids must be filled. Throws base::Error
/// naming `path`.
[[nodiscard]] scene::Heightfield to_local_grid(const Raster& raster,
                                               const std::filesystem::path& path);

} // namespace sward::assets
