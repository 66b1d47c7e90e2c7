// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "assets/gdal_raster.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/room.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

constexpr double kWidest_m = 1.2e6; // beyond it a flat frame has nothing to do with the Earth
constexpr int kOutlinePoints =
    2048; // a side; the rest of the outline is as good as straight between them
constexpr double kRim =
    0.02; // posts past the raster's last one that are still that one: a projection's rounding

base::Error bad(const fs::path& path, std::string_view what, const std::string& found,
                std::string_view expected, base::ExitCode code = base::ExitCode::kBadInput) {
    base::refuse_if_starved();
    return base::input_error(code, path, 0, what, found, expected);
}

std::vector<glm::dvec2> outline_metres(const Raster& raster) {
    std::vector<glm::dvec2> points =
        outline({0, 0}, {raster.width - 1, raster.height - 1}, kOutlinePoints);
    raster.placement->posts_to_metres(points);
    return points;
}

/// Half the sides of the largest rectangle about the origin inside the outline: the raster's own
/// proportions first, then each side grown as far as it goes. Sampled points of the outline that
/// lie outside the rectangle prove it inside.
glm::dvec2 inscribed(const std::vector<glm::dvec2>& points) {
    glm::dvec2 box(0);
    for (const glm::dvec2& p : points)
        box = glm::max(box, glm::abs(p));
    double share = 1;
    for (const glm::dvec2& p : points)
        share = std::min(share, std::max(std::abs(p.x) / box.x, std::abs(p.y) / box.y));
    glm::dvec2 half = box * share;
    glm::dvec2 grown = box;
    for (const glm::dvec2& p : points)
        if (std::abs(p.y) < half.y)
            grown.x = std::min(grown.x, std::abs(p.x));
    half.x = std::max(half.x, grown.x);
    for (const glm::dvec2& p : points)
        if (std::abs(p.x) < half.x)
            grown.y = std::min(grown.y, std::abs(p.y));
    half.y = std::max(half.y, grown.y);
    return half;
}

/// The raster's own spacing at its middle, as spacing of the new grid. A raster that is turned
/// takes the finer for both.
glm::dvec2 spacing(const Raster& raster) {
    const glm::dvec2 middle = glm::dvec2(raster.width - 1, raster.height - 1) / 2.0;
    std::vector<glm::dvec2> cross = {middle - glm::dvec2(0.5, 0), middle + glm::dvec2(0.5, 0),
                                     middle - glm::dvec2(0, 0.5), middle + glm::dvec2(0, 0.5)};
    raster.placement->posts_to_metres(cross);
    const glm::dvec2 column = cross[1] - cross[0], row = cross[3] - cross[2];
    constexpr double kTurned = 0.1; // tangent of the angle
    if (std::abs(column.y) > kTurned * std::abs(column.x) ||
        std::abs(row.x) > kTurned * std::abs(row.y))
        return glm::dvec2(std::min(glm::length(column), glm::length(row)));
    return {glm::length(column), glm::length(row)};
}

/// Catmull-Rom weights of the four posts around a place `t` past the second.
std::array<double, 4> weights(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
            0.5 * (t3 - t2)};
}

float bicubic(const Raster& raster, glm::dvec2 post) {
    if (!std::isfinite(post.x) || !std::isfinite(post.y))
        return std::numeric_limits<float>::quiet_NaN();
    post = glm::clamp(post, glm::dvec2(0), glm::dvec2(raster.width - 1, raster.height - 1));
    const glm::ivec2 at(glm::floor(post));
    const auto wx = weights(post.x - at.x), wy = weights(post.y - at.y);
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
        const auto row = static_cast<std::size_t>(std::clamp(at.y + j - 1, 0, raster.height - 1));
        for (int i = 0; i < 4; ++i) {
            const auto column =
                static_cast<std::size_t>(std::clamp(at.x + i - 1, 0, raster.width - 1));
            sum += wx[i] * wy[j] * double(raster.values[row * raster.width + column]);
        }
    }
    return static_cast<float>(sum);
}

/// Posts along one side, and their spacing: the raster's own where there are many. Odd stays odd:
/// then the new posts stand on the old ones near the middle, and peaks keep their height. A raster
/// a few posts wide is spread over all that it covers.
std::pair<int, double> divide(double extent, double spacing, int source_posts) {
    constexpr double kFew = 8;
    double posts = std::floor(extent / spacing + kRim) + 1;
    if (posts < kFew || source_posts < kFew) {
        posts =
            std::clamp(std::round(extent / spacing) + 1, 2.0, double(std::max(source_posts, 2)));
        return {static_cast<int>(posts), extent / (posts - 1)};
    }
    posts -= std::fmod(std::abs(source_posts - posts), 2.0);
    return {static_cast<int>(std::min(posts, double(kMostSide) + 1)), spacing};
}

} // namespace

scene::Heightfield to_local_grid(const Raster& raster, const fs::path& path) {
    const std::vector<glm::dvec2> points = outline_metres(raster);
    if (std::any_of(points.begin(), points.end(),
                    [](glm::dvec2 p) { return !std::isfinite(p.x + p.y); }))
        throw bad(path, "place on Earth", "an outline that leaves the Earth",
                  "a raster that lies on it");
    const glm::dvec2 half = inscribed(points);
    scene::Heightfield field;
    field.origin = raster.placement->frame();
    const glm::dvec2 own = spacing(raster);
    if (!(own.x >= 1e-3 && own.y >= 1e-3))
        throw bad(path, "spacing of the posts", fmt::format("{} x {} m", own.x, own.y),
                  "at least 0.001 m");
    if (!(2 * half.x <= kWidest_m && 2 * half.y <= kWidest_m))
        throw bad(path, "extent", fmt::format("{:.0f} x {:.0f} km", half.x / 500, half.y / 500),
                  fmt::format("at most {:.0f} km a side for a flat frame", kWidest_m / 1000),
                  base::ExitCode::kOverLimit);
    std::tie(field.width, field.spacing_m.x) = divide(2 * half.x, own.x, raster.width);
    std::tie(field.height, field.spacing_m.y) = divide(2 * half.y, own.y, raster.height);
    check_size(path, field.width, field.height, 1, sizeof(float),
               std::numeric_limits<std::uint64_t>::max(), 2);
    if (!(field.spacing_m.x > 0 && field.spacing_m.y > 0))
        throw bad(path, "size", fmt::format("{} x {} posts", raster.width, raster.height),
                  "posts that enclose an upright rectangle");

    const PostGrid posts(*raster.placement, -0.5 * field.extent_m(), field.spacing_m,
                         {field.width, field.height});
    field.metres.reserve(static_cast<std::size_t>(field.width) * field.height);
    for (int j = 0; j < field.height; ++j)
        for (int i = 0; i < field.width; ++i)
            field.metres.push_back(bicubic(raster, posts.at(i, j)));
    scene::fill_voids(field.width, field.height,
                      field.metres); // places that the projection could not reach
    if (std::isnan(field.metres.front()))
        throw bad(path, "place on Earth", "no post that can be projected",
                  "a raster that lies on it");
    return field;
}

} // namespace sward::assets
