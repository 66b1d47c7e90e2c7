// SPDX-License-Identifier: Apache-2.0
#include "scene/heightfield.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"
#include "base/file.h"
#include "scene/bare_void.h"

namespace sward::scene {
namespace {

/// Posts of a tile, west to east and north to south. North of 50 degrees a tile may have twice the
/// spacing in longitude.
constexpr std::array<glm::ivec2, 5> kTiles = {
    {{1201, 1201}, {3601, 3601}, {7201, 7201}, {601, 1201}, {1801, 3601}}};

std::uint64_t tile_bytes(glm::ivec2 posts) {
    return std::uint64_t(posts.x) * std::uint64_t(posts.y) * 2;
}

base::Error bad(const std::filesystem::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    return base::input_error(base::ExitCode::kBadInput, path, 0, what, found, expected);
}

/// The tile's south-west corner from a name like N36W085.hgt.
std::optional<Georeference> corner(const std::string& stem) {
    if (stem.size() < 7)
        return std::nullopt;
    const auto upper = [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    };
    const char ns = upper(stem[0]), ew = upper(stem[3]);
    int latitude = 0, longitude = 0;
    const char* text = stem.data();
    if ((ns != 'N' && ns != 'S') || (ew != 'E' && ew != 'W') ||
        std::from_chars(text + 1, text + 3, latitude).ptr != text + 3 ||
        std::from_chars(text + 4, text + 7, longitude).ptr != text + 7)
        return std::nullopt;
    if (latitude < 0 || latitude > 90 || longitude < 0 || longitude > 180)
        return std::nullopt;
    Georeference place;
    place.latitude_deg = ns == 'N' ? double(latitude) : -double(latitude);
    place.longitude_deg = ew == 'E' ? double(longitude) : -double(longitude);
    if (place.latitude_deg >= 90) // the tile would lie past the pole
        return std::nullopt;
    return place;
}

/// Metres of one degree, east and north, at a latitude of the WGS 84 ellipsoid (its two radii of
/// curvature).
glm::dvec2 metres_per_degree(double latitude_deg) {
    constexpr double kA = 6378137.0, kF = 1 / 298.257223563, kE2 = kF * (2 - kF);
    const double radians = latitude_deg * base::kDegree;
    const double s = std::sin(radians), w = std::sqrt(1 - kE2 * s * s);
    const double across = kA / w, along = kA * (1 - kE2) / (w * w * w);
    return glm::dvec2(across * std::cos(radians), along) * base::kDegree;
}

} // namespace

std::size_t fill_voids(int width, int height, std::vector<float>& metres) {
    const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
    /// The mean of the neighbours that have a height now, or NaN.
    const auto around = [&](std::size_t post) {
        const int x0 = static_cast<int>(post % width), y0 = static_cast<int>(post / width);
        double sum = 0;
        int count = 0;
        for (int y = std::max(0, y0 - 1); y <= std::min(height - 1, y0 + 1); ++y)
            for (int x = std::max(0, x0 - 1); x <= std::min(width - 1, x0 + 1); ++x)
                if (const float h = metres[at(x, y)]; !std::isnan(h))
                    sum += h, ++count;
        return count > 0 ? static_cast<float>(sum / count)
                         : std::numeric_limits<float>::quiet_NaN();
    };

    std::vector<std::size_t> ring;
    for (std::size_t post = 0; post < metres.size(); ++post)
        if (std::isnan(metres[post]) && !std::isnan(around(post)))
            ring.push_back(post);
    std::size_t filled = 0;
    std::vector<float> heights;
    while (!ring.empty()) {
        // All of a ring from the heights outside it, then all at once: the order within the ring
        // does not matter.
        heights.clear();
        for (const std::size_t post : ring)
            heights.push_back(around(post));
        for (std::size_t i = 0; i < ring.size(); ++i)
            metres[ring[i]] = heights[i];
        filled += ring.size();
        std::vector<std::size_t> next;
        for (const std::size_t post : ring) {
            const int x0 = static_cast<int>(post % width), y0 = static_cast<int>(post / width);
            for (int y = std::max(0, y0 - 1); y <= std::min(height - 1, y0 + 1); ++y)
                for (int x = std::max(0, x0 - 1); x <= std::min(width - 1, x0 + 1); ++x)
                    if (std::isnan(metres[at(x, y)]))
                        next.push_back(at(x, y));
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        ring = std::move(next);
    }
    return filled;
}

bool is_void(double value) {
    return value == -32768 || value == -32767 || value == -32000;
}

bool is_bare_void(float value, bool declared) {
    return std::isnan(value) || is_void(value) ||
           (std::isfinite(value) && std::abs(value) >= 3.4e38f) ||
           (!declared && (value == -9999 || value == -99999 || value == -2147483648.0f));
}

glm::dvec2 linear_place(const Georeference& frame, double latitude_deg, double longitude_deg) {
    const double east = std::remainder(longitude_deg - frame.longitude_deg, 360.0);
    return {east * frame.metres_per_degree.x,
            (frame.latitude_deg - latitude_deg) * frame.metres_per_degree.y};
}

Heightfield read_hgt(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = base::read_file(path, tile_bytes(kTiles[2]));
    const auto tile = std::find_if(kTiles.begin(), kTiles.end(),
                                   [&](glm::ivec2 t) { return tile_bytes(t) == bytes.size(); });
    if (tile == kTiles.end())
        throw bad(path, "not an .hgt tile", fmt::format("{} bytes", bytes.size()),
                  fmt::format("{} bytes (1201 x 1201 posts), {} (3601 x 3601) or {} (1801 x 3601)",
                              tile_bytes(kTiles[0]), tile_bytes(kTiles[1]), tile_bytes(kTiles[4])));
    const auto south_west = corner(path.stem().string());
    if (!south_west)
        throw bad(path, "name of an .hgt tile", base::printable(path.stem().native()),
                  "a name like N36W085.hgt");

    Heightfield field;
    field.width = tile->x;
    field.height = tile->y;
    Georeference origin;
    origin.latitude_deg = south_west->latitude_deg + 0.5;
    origin.longitude_deg = south_west->longitude_deg + 0.5;
    origin.metres_per_degree = metres_per_degree(origin.latitude_deg);
    origin.source = "WGS 84";
    field.spacing_m = origin.metres_per_degree / glm::dvec2(*tile - 1);
    field.origin = origin;
    field.metres.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        const auto word = static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[i]) << 8 |
                                                     std::to_integer<unsigned>(bytes[i + 1]));
        const auto metres = static_cast<std::int16_t>(word);
        field.metres.push_back(is_void(metres) ? std::numeric_limits<float>::quiet_NaN()
                                               : float(metres));
    }
    fill_voids(field.width, field.height, field.metres);
    if (std::isnan(field.metres.front())) // one left over means that all are
        throw bad(path, "no elevation", "voids (-32768) only", "heights");
    return field;
}

} // namespace sward::scene
