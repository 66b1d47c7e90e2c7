// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "assets/gdal_raster.h"
#include "assets/limits.h"
#include "base/error.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

constexpr double kWidest_m = 1e6; // beyond it a flat frame has nothing to do with the Earth
constexpr int kOutlinePoints =
    2048; // a side; the rest of the outline is as good as straight between them
constexpr int kCell =
    16; // posts between exact transformations; linear between them errs by under 1e-4 posts

constexpr double kRim =
    0.02; // posts past the raster's last one that are still that one: a projection's rounding

base::Error bad(const fs::path& path, std::string_view what, const std::string& found,
                std::string_view expected, base::ExitCode code = base::ExitCode::kBadInput) {
    return base::input_error(code, path, 0, what, found, expected);
}

std::vector<glm::dvec2> outline(const Raster& raster) {
    const glm::dvec2 last(raster.width - 1, raster.height - 1);
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= kOutlinePoints; ++i) {
        const glm::dvec2 p = last * (double(i) / kOutlinePoints);
        for (const glm::dvec2 q : {glm::dvec2(p.x, 0), glm::dvec2(p.x, last.y), glm::dvec2(0, p.y),
                                   glm::dvec2(last.x, p.y)})
            points.push_back(q);
    }
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

/// Source posts under each kCell-th post of the grid, exact; one more row and column past the end.
struct Nodes {
    int columns = 0;
    std::vector<glm::dvec2> posts;

    [[nodiscard]] glm::dvec2 between(int i, int j) const {
        const int ci = i / kCell, cj = j / kCell;
        const double u = double(i % kCell) / kCell, v = double(j % kCell) / kCell;
        const glm::dvec2* p = &posts[static_cast<std::size_t>(cj) * columns + ci];
        return glm::mix(glm::mix(p[0], p[1], u), glm::mix(p[columns], p[columns + 1], u), v);
    }
};

Nodes make_nodes(const Raster& raster, const scene::Heightfield& field) {
    Nodes nodes;
    nodes.columns = (field.width - 1) / kCell + 2;
    const int rows = (field.height - 1) / kCell + 2;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < nodes.columns; ++i)
            nodes.posts.emplace_back((i * kCell - (field.width - 1) / 2.0) * field.spacing_m.x,
                                     -(j * kCell - (field.height - 1) / 2.0) *
                                         field.spacing_m.y); // north is up
    raster.placement->metres_to_posts(nodes.posts);
    return nodes;
}

} // namespace

scene::Heightfield to_local_grid(const Raster& raster, const fs::path& path) {
    const std::vector<glm::dvec2> points = outline(raster);
    if (std::any_of(points.begin(), points.end(),
                    [](glm::dvec2 p) { return !std::isfinite(p.x + p.y); }))
        throw bad(path, "place on Earth", "an outline that leaves the Earth",
                  "a raster that lies on it");
    const glm::dvec2 half = inscribed(points);
    scene::Heightfield field;
    field.origin = raster.placement->middle();
    field.spacing_m = spacing(raster);
    if (!(field.spacing_m.x >= 1e-3 && field.spacing_m.y >= 1e-3))
        throw bad(path, "spacing of the posts",
                  fmt::format("{} x {} m", field.spacing_m.x, field.spacing_m.y),
                  "at least 0.001 m");
    if (!(2 * half.x <= kWidest_m && 2 * half.y <= kWidest_m))
        throw bad(path, "extent", fmt::format("{:.0f} x {:.0f} km", half.x / 500, half.y / 500),
                  fmt::format("at most {:.0f} km a side for a flat frame", kWidest_m / 1000),
                  base::ExitCode::kOverLimit);
    glm::dvec2 posts = glm::floor(2.0 * half / field.spacing_m + kRim) + 1.0;
    // Odd stays odd: then the new posts stand on the old ones near the middle, and peaks keep their
    // height.
    posts -= glm::mod(glm::dvec2(raster.width, raster.height) - posts, 2.0);
    if (!(posts.x >= 2 && posts.y >= 2))
        throw bad(path, "size", fmt::format("{} x {} posts", raster.width, raster.height),
                  "enough for an upright rectangle of 2 x 2");
    check_size(path, static_cast<std::int64_t>(posts.x), static_cast<std::int64_t>(posts.y), 1,
               sizeof(float), std::numeric_limits<std::uint64_t>::max(), 2);
    field.width = static_cast<int>(posts.x);
    field.height = static_cast<int>(posts.y);

    const Nodes nodes = make_nodes(raster, field);
    field.metres.reserve(static_cast<std::size_t>(field.width) * field.height);
    for (int j = 0; j < field.height; ++j)
        for (int i = 0; i < field.width; ++i)
            field.metres.push_back(bicubic(raster, nodes.between(i, j)));
    scene::fill_voids(field.width, field.height,
                      field.metres); // places that the projection could not reach
    if (std::isnan(field.metres.front()))
        throw bad(path, "place on Earth", "no post that can be projected",
                  "a raster that lies on it");
    return field;
}

} // namespace sward::assets
