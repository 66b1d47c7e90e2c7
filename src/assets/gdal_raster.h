// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "assets/placement.h"
#include "scene/heightfield.h"

namespace sward::assets {

struct Raster {
    int width = 0;
    int height = 0;
    std::vector<float>
        values; ///< NaN where the file has no value; scale, offset and unit of the file are applied
    double full_scale = 0; ///< of an unsigned integer type (255, 4095 of 12 bits, 65535), else 0
    bool has_unit = false; ///< the file says what its values are: a unit, or a scale
    std::unique_ptr<Placement> placement;     ///< null where the file has no place on Earth
    std::optional<glm::dvec2> bare_spacing_m; ///< of a file in the coordinates of a building site
};

/// One band (from 1) of a local elevation file, through the few GDAL drivers that follow no
/// reference to another place. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Raster read_gdal_raster(const std::filesystem::path& path, int band);

/// What the writers of voids leave undeclared, in values that are metres already: the codes of the
/// SRTM and the USGS, the largest floats, NaN, and where the file names no number (`declared`)
/// -9999, -99999 and the least integer.
[[nodiscard]] bool is_bare_void(float value, bool declared);

/// Versions of GDAL and PROJ.
[[nodiscard]] std::string gdal_versions();

/// The raster on a regular grid of its Placement's metres: the largest rectangle about the middle
/// that the raster covers, at its own spacing, bicubic. Voids must be filled. Throws base::Error
/// naming `path`.
[[nodiscard]] scene::Heightfield to_local_grid(const Raster& raster,
                                               const std::filesystem::path& path);

} // namespace sward::assets
