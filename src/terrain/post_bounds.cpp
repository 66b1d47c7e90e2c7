// SPDX-License-Identifier: Apache-2.0
#include "terrain/post_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sward::terrain {
namespace {

constexpr int kBaseCells = 4;   // a side: half a byte a post
constexpr int kExactCells = 16; // in a rectangle that is looked up cell by cell

const glm::vec2 kNothing(std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest());

void widen(glm::vec2& range, glm::vec2 by) {
    range = {std::min(range.x, by.x), std::max(range.y, by.y)};
}
void widen(glm::vec2& range, float by) {
    widen(range, glm::vec2(by));
}

float post(const scene::Heightfield& field, int i, int j) {
    i = std::clamp(i, 0, field.width - 1);
    j = std::clamp(j, 0, field.height - 1);
    return field.metres[static_cast<std::size_t>(j) * static_cast<std::size_t>(field.width) +
                        static_cast<std::size_t>(i)];
}

using Row = std::array<std::vector<float>, 4>; // Bezier control points along x, of every cell

Row control_row(const scene::Heightfield& field, int j) {
    Row row;
    for (std::vector<float>& points : row)
        points.resize(static_cast<std::size_t>(field.width - 1));
    for (int i = 0; i + 1 < field.width; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const float p0 = post(field, i - 1, j), p1 = post(field, i, j), p2 = post(field, i + 1, j),
                    p3 = post(field, i + 2, j);
        row[0][at] = p1;
        row[1][at] = p1 + (p2 - p0) / 6;
        row[2][at] = p2 - (p3 - p1) / 6;
        row[3][at] = p2;
    }
    return row;
}

/// The hull of each cell between rows j and j + 1, into the base level.
void add_cells(const std::array<Row, 4>& rows, int cells, std::vector<glm::vec2>& ranges) {
    for (int i = 0; i < cells; ++i) {
        const auto at = static_cast<std::size_t>(i);
        glm::vec2 range = kNothing;
        for (std::size_t c = 0; c < 4; ++c) {
            const float p0 = rows[0][c][at], p1 = rows[1][c][at], p2 = rows[2][c][at],
                        p3 = rows[3][c][at];
            const float b1 = p1 + (p2 - p0) / 6, b2 = p2 - (p3 - p1) / 6;
            range = {std::min({range.x, p1, p2, b1, b2}), std::max({range.y, p1, p2, b1, b2})};
        }
        widen(ranges[static_cast<std::size_t>(i / kBaseCells)], range);
    }
}

/// Weights of four posts for the Bezier control points of the curve from `a` to `b` (0..1) between
/// the middle two.
std::array<glm::dvec4, 4> control_weights(double a, double b) {
    const auto value = [](double t) {
        const double t2 = t * t, t3 = t2 * t;
        return glm::dvec4(-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1,
                          -1.5 * t3 + 2 * t2 + 0.5 * t, 0.5 * (t3 - t2));
    };
    const auto slope = [](double t) {
        const double t2 = t * t;
        return glm::dvec4(-1.5 * t2 + 2 * t - 0.5, 4.5 * t2 - 5 * t, -4.5 * t2 + 4 * t + 0.5,
                          1.5 * t2 - t);
    };
    const double third = (b - a) / 3;
    return {value(a), value(a) + slope(a) * third, value(b) - slope(b) * third, value(b)};
}

/// The hull of the surface over part of a cell.
glm::vec2 part_of_cell(const scene::Heightfield& field, glm::ivec2 cell, glm::dvec2 low,
                       glm::dvec2 high) {
    const auto along = control_weights(low.x, high.x), down = control_weights(low.y, high.y);
    glm::vec2 range = kNothing;
    std::array<glm::dvec4, 4> rows;
    for (int j = 0; j < 4; ++j) {
        glm::dvec4 posts;
        for (int i = 0; i < 4; ++i)
            posts[i] = post(field, cell.x + i - 1, cell.y + j - 1);
        for (std::size_t c = 0; c < 4; ++c)
            rows[c][j] = glm::dot(along[c], posts);
    }
    for (const glm::dvec4& column : rows)
        for (const glm::dvec4& weights : down)
            widen(range, static_cast<float>(glm::dot(weights, column)));
    return range;
}

} // namespace

PostBounds::PostBounds(const scene::Heightfield& field) {
    const int columns = field.width - 1, lines = field.height - 1; // cells
    Level base;
    base.width = (columns + kBaseCells - 1) / kBaseCells;
    base.height = (lines + kBaseCells - 1) / kBaseCells;
    base.ranges.assign(static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height),
                       kNothing);
    std::array<Row, 4> rows = {control_row(field, -1), control_row(field, 0), control_row(field, 1),
                               control_row(field, 2)};
    std::vector<glm::vec2> line(static_cast<std::size_t>(base.width), kNothing);
    for (int j = 0; j < lines; ++j) {
        add_cells(rows, columns, line);
        if (j % kBaseCells == kBaseCells - 1 || j == lines - 1) {
            std::copy(line.begin(), line.end(),
                      base.ranges.begin() + std::ptrdiff_t{j / kBaseCells} * base.width);
            std::fill(line.begin(), line.end(), kNothing);
        }
        std::rotate(rows.begin(), rows.begin() + 1, rows.end());
        rows[3] = control_row(field, j + 3);
    }
    levels_.push_back(std::move(base));
    while (levels_.back().ranges.size() > 1) {
        const Level& fine = levels_.back();
        Level coarse;
        coarse.width = (fine.width + 1) / 2;
        coarse.height = (fine.height + 1) / 2;
        coarse.ranges.assign(static_cast<std::size_t>(coarse.width) *
                                 static_cast<std::size_t>(coarse.height),
                             kNothing);
        for (int j = 0; j < fine.height; ++j)
            for (int i = 0; i < fine.width; ++i)
                widen(
                    coarse.ranges[static_cast<std::size_t>(j / 2) *
                                      static_cast<std::size_t>(coarse.width) +
                                  static_cast<std::size_t>(i / 2)],
                    fine.ranges[static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.width) +
                                static_cast<std::size_t>(i)]);
        levels_.push_back(std::move(coarse));
    }
}

glm::vec2 PostBounds::over(glm::dvec2 low, glm::dvec2 high, const scene::Heightfield& field) const {
    const glm::dvec2 last(field.width - 1, field.height - 1);
    low = glm::clamp(low, glm::dvec2(0), last);
    high = glm::clamp(high, low, last);
    const glm::ivec2 most(field.width - 2, field.height - 2);
    const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low)), glm::ivec2(0), most);
    const glm::ivec2 end = glm::clamp(glm::ivec2(glm::floor(high)), first, most);
    const glm::ivec2 count = end - first + 1;
    glm::vec2 range = kNothing;
    if (count.x <= kExactCells && count.y <= kExactCells && count.x * count.y <= kExactCells) {
        for (int j = first.y; j <= end.y; ++j)
            for (int i = first.x; i <= end.x; ++i) {
                const glm::dvec2 cell(i, j);
                widen(range, part_of_cell(field, {i, j}, glm::clamp(low - cell, 0.0, 1.0),
                                          glm::clamp(high - cell, 0.0, 1.0)));
            }
        return range;
    }
    // Nodes at most a quarter as wide as the rectangle, where there are such: what they hold beside
    // it stays little.
    std::size_t level = 0;
    while (level + 1 < levels_.size() &&
           (kBaseCells << (level + 1)) * 4 <= std::max(count.x, count.y))
        ++level;
    const Level& nodes = levels_[level];
    const int side = kBaseCells << level;
    for (int j = first.y / side; j <= end.y / side; ++j)
        for (int i = first.x / side; i <= end.x / side; ++i)
            widen(range,
                  nodes.ranges[static_cast<std::size_t>(j) * static_cast<std::size_t>(nodes.width) +
                               static_cast<std::size_t>(i)]);
    return range;
}

} // namespace sward::terrain
