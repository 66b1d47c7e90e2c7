// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace sward::scene {

/// Where the local frame's origin lies, for elevation that carries a CRS. Degrees, WGS 84.
struct Georeference {
    double latitude_deg = 0;
    double longitude_deg = 0;
};

/// Elevation on a regular grid of posts in the local east-north-up frame: x east, z south, metres from the centre.
/// Post (column i, row j) stands at x = (i - (width - 1) / 2) * spacing_m.x, z = (j - (height - 1) / 2) * spacing_m.y;
/// row 0 is the north rim. Every value is finite.
struct Heightfield {
    int width = 0;  ///< posts west to east, at least 2
    int height = 0; ///< posts north to south, at least 2
    glm::dvec2 spacing_m{1, 1};
    std::vector<float> metres; ///< width * height, row-major, above the datum
    std::optional<Georeference> origin;

    [[nodiscard]] glm::dvec2 extent_m() const {
        return {spacing_m.x * (width - 1), spacing_m.y * (height - 1)};
    }
};

/// Density of the grass, 0..1, over the same extent as the elevation; texel centres as in an image, row 0 north.
struct DensityMask {
    int width = 0;
    int height = 0;
    std::vector<float> density; ///< width * height
};

/// SRTM .hgt tile (big-endian int16, 1201 or 3601 square, named like N36W085.hgt) on the metres of its middle latitude
/// (WGS 84 radii). Voids (-32768) are filled from their nearest neighbours. Throws Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Heightfield read_hgt(const std::filesystem::path& path);

/// Gives every NaN post the mean of its nearest neighbours that have a height, ring by ring from the rim of the hole
/// inwards. Returns how many it filled; fills none where no post has a height.
std::size_t fill_voids(int width, int height, std::vector<float>& metres);

/// Raw little-endian float32 posts, row-major, beside a JSON header of the same name and extension .json
/// {"width", "height", "spacing_m": [x, z]}: what the core build reads without GDAL. Throws like read_hgt.
[[nodiscard]] Heightfield read_raw_elevation(const std::filesystem::path& path);

} // namespace sward::scene
