// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sward::scene {

/// Where the local frame lies on Earth, for elevation that carries a CRS.
struct Georeference {
    double latitude_deg = 0;  ///< of the origin, WGS 84
    double longitude_deg = 0; ///< -180 to 180
    std::string
        crs; ///< WKT of a CRS whose metres east and north are x and -z; empty: by metres_per_degree
    glm::dvec2 metres_per_degree{0, 0}; ///< of WGS 84 longitude and latitude, where `crs` is empty
    std::string source; ///< name of the CRS that the elevation's file carries, for people
};

/// x, z of a place in a frame that metres_per_degree describes.
[[nodiscard]] glm::dvec2 linear_place(const Georeference& frame, double latitude_deg,
                                      double longitude_deg);

/// Elevation on a regular grid of posts in the local east-north-up frame: x east, z south, metres
/// from the centre. Post (column i, row j) stands at x = (i - (width - 1) / 2) * spacing_m.x, z =
/// (j - (height - 1) / 2) * spacing_m.y; row 0 is the north rim. Every value is finite.
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

/// Bytes of a texel of DensityMask::land, all linear, so that their means mean something. Shares
/// are over 255.
enum LandByte {
    kLandHeight,  ///< factor on height / kLandMostHeight, times the share that bears grass
    kLandDryness, ///< 0.5 + dryness / 2
    kLandWater,   ///< share, as those below; what is left is soil
    kLandAsphalt,
    kLandGravel,
    kLandSand,
    kLandRock,
    kLandBare, ///< where no grass can grow
    kLandBytes
};
inline constexpr double kLandMostHeight = 2;

/// Density of the grass, 0..1, over a rectangle of the terrain; texel centres as in an image, row 0
/// north.
struct DensityMask {
    int width = 0;
    int height = 0;
    std::vector<float> density; ///< width * height
    glm::dvec2 first_m{0, 0};   ///< x, z of the north-west corner
    glm::dvec2 size_m{
        0, 0}; ///< of the rectangle; zero: the elevation's, from its first post to its last
    bool bounded = false; ///< no grass outside the rectangle; else its rim goes on
    /// Of a landcover whose classes say more than a density: kLandBytes a texel, by LandByte; else
    /// empty.
    std::vector<std::uint8_t> land{};
    double highest = 1; ///< greatest factor on height among the classes that bear grass, at least 1
    bool heights = false; ///< is any of those not 1?
    std::optional<std::array<std::uint8_t, 9>>
        outside{}; ///< what goes on beyond the rectangle: density * 255, then as of `land`
    std::map<int, double>
        class_shares{}; ///< of the terrain's area, by class of a landcover; -1: no value there
};

/// SRTM .hgt tile (big-endian int16, named like N36W085.hgt; 1201, 3601 or 7201 rows, and as many
/// columns or, in the north, half as many) on the metres of its middle latitude (WGS 84 radii).
/// Voids (-32768, -32767, -32000) are filled from their nearest neighbours. Throws Error: kIo,
/// kBadInput, kOverLimit.
[[nodiscard]] Heightfield read_hgt(const std::filesystem::path& path);

/// Gives every NaN post the mean of its nearest neighbours that have a height, ring by ring from
/// the rim of the hole inwards. Returns how many it filled; fills none where no post has a height.
std::size_t fill_voids(int width, int height, std::vector<float>& metres);

/// Whether a value stands for "no height" in elevation of the SRTM and of the USGS, whatever the
/// file declares.
[[nodiscard]] bool is_void(double value);

/// A square of little-endian uint16 (.r16, or .raw as game engines write it), row 0 in the north,
/// over `size_m` from the first post to the last; `height_m`: metres at 0 and at 65535. Throws like
/// read_hgt.
[[nodiscard]] Heightfield read_raw16(const std::filesystem::path& path, glm::dvec2 size_m,
                                     glm::dvec2 height_m);

/// Raw little-endian float32 posts, row-major, beside a JSON header of the same name and extension
/// .json
/// {"width", "height", "spacing_m": [x, z]}: what the core build reads without GDAL. Throws like
/// read_hgt.
[[nodiscard]] Heightfield read_raw_elevation(const std::filesystem::path& path);

} // namespace sward::scene
