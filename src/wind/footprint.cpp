// SPDX-License-Identifier: Apache-2.0
#include "wind/footprint.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sward::wind {
namespace {

constexpr double kBitsPerCell = 4;
constexpr double kMostBits = 4096; // a side
constexpr int kRim = 1;            // bits around everything, so that no crossing is lost at the rim

/// A piece of the contour; the mesh's inside is on one side of all of them, where it is well
/// oriented.
struct Segment {
    glm::dvec2 from, to;
};

/// Corners on the plane count as above, so that neighbours agree and closed meshes give closed
/// contours.
std::optional<Segment> cut(const glm::dvec3 (&corner)[3], double height) {
    const bool above[3] = {corner[0].y >= height, corner[1].y >= height, corner[2].y >= height};
    if (above[0] == above[1] && above[1] == above[2])
        return std::nullopt;
    Segment segment{};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (above[i] == above[j])
            continue;
        // From the lower end whatever the triangle: both that share the edge find the same point.
        const glm::dvec3 &low = above[i] ? corner[j] : corner[i],
                         &high = above[i] ? corner[i] : corner[j];
        const glm::dvec3 at = glm::mix(low, high, (height - low.y) / (high.y - low.y));
        (above[i] ? segment.from : segment.to) = {at.x, at.z};
    }
    return segment;
}

std::vector<Segment> contour_of(const scene::Mesh& mesh, double height_m) {
    std::vector<Segment> contour;
    for (const auto& triangle : mesh.triangles) {
        const glm::dvec3 corners[3] = {mesh.positions[triangle[0]], mesh.positions[triangle[1]],
                                       mesh.positions[triangle[2]]};
        if (const auto segment = cut(corners, height_m))
            contour.push_back(*segment);
    }
    return contour;
}

void set_bit(Footprint& print, int column, int row) {
    const auto bit = static_cast<std::size_t>(row) * static_cast<std::size_t>(print.width) +
                     static_cast<std::size_t>(column);
    print.words[bit / 32] |= 1U << (bit % 32);
}

int clamped(double value, int most) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(most)));
}

double distance_to(const Segment& segment, glm::dvec2 point) {
    const glm::dvec2 along = segment.to - segment.from;
    const double squared = glm::dot(along, along);
    const double t =
        squared > 0 ? std::clamp(glm::dot(point - segment.from, along) / squared, 0.0, 1.0) : 0;
    return glm::distance(point, segment.from + along * t);
}

/// Every bit whose centre lies within `reach_m` of the segment.
void draw_segment(Footprint& print, const Segment& segment, double reach_m) {
    const auto bits = [&](double metres, double corner) { return (metres - corner) / print.bit_m; };
    const glm::dvec2 least = glm::min(segment.from, segment.to) - reach_m,
                     most = glm::max(segment.from, segment.to) + reach_m;
    for (int row = clamped(bits(least.y, print.corner_m.y), print.height - 1);
         row <= clamped(bits(most.y, print.corner_m.y), print.height - 1); ++row) {
        const double z = print.corner_m.y + (row + 0.5) * print.bit_m;
        // Only the part of the segment near this row: a long diagonal must not cost its whole
        // rectangle.
        double x0 = least.x, x1 = most.x;
        const glm::dvec2 along = segment.to - segment.from;
        if (std::abs(along.y) > print.bit_m) {
            const auto x_at = [&](double row_z) {
                return segment.from.x +
                       along.x * std::clamp((row_z - segment.from.y) / along.y, 0.0, 1.0);
            };
            const double a = x_at(z - reach_m), b = x_at(z + reach_m);
            x0 = std::min(a, b) - reach_m;
            x1 = std::max(a, b) + reach_m;
        }
        for (int column = clamped(bits(x0, print.corner_m.x), print.width - 1);
             column <= clamped(bits(x1, print.corner_m.x), print.width - 1); ++column)
            if (distance_to(segment, {print.corner_m.x + (column + 0.5) * print.bit_m, z}) <=
                reach_m)
                set_bit(print, column, row);
    }
}

/// Where the contour crosses the middle line of a row, and which way.
struct Crossing {
    double x;
    int turn;
};

/// Fills a row between crossings whose winding number is not 0; an open contour leaves it as it is.
void fill_row(Footprint& print, int row, std::vector<Crossing>& crossings) {
    int sum = 0;
    for (const Crossing& crossing : crossings)
        sum += crossing.turn;
    if (sum != 0)
        return;
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.x != b.x ? a.x < b.x : a.turn < b.turn;
    });
    int winding = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
        winding += crossings[i].turn;
        if (winding == 0)
            continue;
        const auto first_centre = [&](double x) {
            return (x - print.corner_m.x) / print.bit_m + 0.5;
        };
        for (int column = clamped(first_centre(crossings[i].x), print.width);
             column < clamped(first_centre(crossings[i + 1].x), print.width); ++column)
            set_bit(print, column, row);
    }
}

void fill(Footprint& print, const std::vector<Segment>& contour) {
    std::vector<std::vector<Crossing>> rows(static_cast<std::size_t>(print.height));
    for (const Segment& segment : contour) {
        const double a = (segment.from.y - print.corner_m.y) / print.bit_m - 0.5;
        const double b = (segment.to.y - print.corner_m.y) / print.bit_m - 0.5;
        // Rows r with min <= r < max: an end that two segments share counts once.
        for (int row = clamped(std::ceil(std::min(a, b)), print.height);
             row < clamped(std::ceil(std::max(a, b)), print.height); ++row)
            rows[static_cast<std::size_t>(row)].push_back(
                {segment.from.x + (segment.to.x - segment.from.x) * (row - a) / (b - a),
                 a < b ? 1 : -1});
    }
    for (int row = 0; row < print.height; ++row)
        fill_row(print, row, rows[static_cast<std::size_t>(row)]);
}

} // namespace

Footprint footprint_of(const scene::Mesh& mesh, double height_m, double cell_m) {
    Footprint print;
    const std::vector<Segment> contour = contour_of(mesh, height_m);
    if (contour.empty())
        return print;
    glm::dvec2 least = contour.front().from, most = least;
    for (const Segment& segment : contour) {
        least = glm::min(least, glm::min(segment.from, segment.to));
        most = glm::max(most, glm::max(segment.from, segment.to));
    }
    const double reach = 0.5 * cell_m;
    const glm::dvec2 size = most - least + 2 * reach;
    print.bit_m =
        std::max(cell_m / kBitsPerCell, std::max(size.x, size.y) / (kMostBits - 2 * kRim - 1));
    print.corner_m = least - reach - kRim * print.bit_m;
    print.width = static_cast<int>(std::ceil(size.x / print.bit_m)) + 2 * kRim;
    print.height = static_cast<int>(std::ceil(size.y / print.bit_m)) + 2 * kRim;
    print.words.assign(
        (static_cast<std::size_t>(print.width) * static_cast<std::size_t>(print.height) + 31) / 32,
        0);
    fill(print, contour);
    // A bit's own half diagonal keeps the outline whole where bits are larger than cells.
    const double drawn = std::max(reach, 0.71 * print.bit_m);
    for (const Segment& segment : contour)
        draw_segment(print, segment, drawn);
    return print;
}

} // namespace sward::wind
