// SPDX-License-Identifier: Apache-2.0
#include "texgen/patch/rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/angles.h"

namespace sward::texgen {
namespace {

constexpr int kCells = 128; // along each side of the patch; a power of two
constexpr int kLayers = 16; // of cells, from the ground to the highest blade

/// Which cell of the patch a cell of the plane is, and in which image of the patch it lies.
int in_patch(int cell) {
    return cell & (kCells - 1);
}
int tile_of(int cell) {
    return (cell - in_patch(cell)) / kCells;
}

/// Radical inverse.
double halton(int index, int base) {
    double value = 0, scale = 1.0 / base;
    for (; index > 0; index /= base, scale /= base)
        value += (index % base) * scale;
    return value;
}

/// One axis of a walk through square cells.
struct Walk {
    int cell;
    int step;
    double next;  ///< ray distance to the next cell border
    double delta; ///< between borders

    Walk(double origin, double direction, double width)
        : cell(static_cast<int>(std::floor(origin / width))), step(direction > 0 ? 1 : -1),
          next(1e30), delta(1e30) {
        if (std::abs(direction) < 1e-12)
            return;
        delta = width / std::abs(direction);
        next = ((cell + (direction > 0 ? 1 : 0)) * width - origin) / direction;
    }
    void advance() {
        cell += step;
        next += delta;
    }
};

} // namespace

BladeField::BladeField(std::span<const shared::BladeRecord> blades,
                       std::span<const shared::GrassAppearance> species, double side, double canopy)
    : side_(side), canopy_(canopy), outlines_(outlines_of(blades, species)),
      first_(kCells * kCells * kLayers + 1) {
    pieces_.reserve(outlines_.size() * Outline::kSegments);
    for (const Outline& outline : outlines_) {
        top_ = std::max(top_, outline.high.y);
        for (int i = 0; i < Outline::kSegments; ++i)
            make_piece(outline, i);
    }
    layer_ = std::max(top_, 1e-3) / kLayers;
    for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece)
        each_cell(piece, [&](std::size_t cell, const Item&) { ++first_[cell + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece)
        each_cell(piece, [&](std::size_t cell, const Item& item) { items_[next[cell]++] = item; });
}

void BladeField::make_piece(const Outline& outline, int segment) {
    const auto i = static_cast<std::size_t>(segment);
    Piece piece{
        outline.centre[i], outline.centre[i + 1] - outline.centre[i], outline.across, {}, 0, 0, 0,
        outline.half[i],   outline.half[i + 1] - outline.half[i]};
    piece.normal = glm::cross(piece.along, piece.across);
    piece.plane = glm::dot(piece.centre, piece.normal);
    piece.skew = glm::dot(piece.along, piece.across);
    piece.stretch = 1 / (glm::dot(piece.along, piece.along) - piece.skew * piece.skew);
    pieces_.push_back(piece);
}

/// Calls visit(cell, item) for every cell that the piece's box reaches into.
template<class Visit> void BladeField::each_cell(std::uint32_t number, Visit&& visit) const {
    const Piece& piece = pieces_[number];
    glm::dvec3 low(1e30), high(-1e30);
    for (const double end : {0.0, 1.0})
        for (const double sign : {-1.0, 1.0}) {
            const glm::dvec3 corner = piece.centre + end * piece.along +
                                      sign * (piece.half + end * piece.taper) * piece.across;
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    low -= 1e-6;
    high += 1e-6;
    const auto index = [&](double v) { return static_cast<int>(std::floor(v / side_ * kCells)); };
    const auto layer = [&](double y) {
        return std::clamp(static_cast<int>(std::floor(y / layer_)), 0, kLayers - 1);
    };
    const auto tile = [](int c) { return static_cast<std::int8_t>(-tile_of(c)); };
    const glm::dvec3 middle = piece.centre + 0.5 * piece.along;
    const double radius = 0.5 * glm::length(piece.along) +
                          std::max(piece.half, piece.half + piece.taper) +
                          1e-5; // and what floats lose
    for (int z = index(low.z); z <= index(high.z); ++z)
        for (int x = index(low.x); x <= index(high.x); ++x)
            for (int y = layer(low.y); y <= layer(high.y); ++y)
                visit(static_cast<std::size_t>((in_patch(z) * kCells + in_patch(x)) * kLayers + y),
                      Item{middle + side_ * glm::dvec3(tile(x), 0, tile(z)),
                           static_cast<float>(radius), number, tile(x), tile(z)});
}

std::span<const BladeField::Item> BladeField::cell(int x, int y, int z) const {
    const auto i = static_cast<std::size_t>((in_patch(z) * kCells + in_patch(x)) * kLayers +
                                            std::clamp(y, 0, kLayers - 1));
    return {items_.data() + first_[i], items_.data() + first_[i + 1]};
}

void BladeField::meet(const Item& item, const glm::dvec3& origin, const glm::dvec3& direction,
                      std::optional<RayHit>& best) const {
    const Piece& piece = pieces_[item.piece];
    // origin + t direction = centre + a along + w across: a 3 x 3 system by Cramer's rule.
    const double det = glm::dot(direction, piece.normal);
    if (std::abs(det) < 1e-15)
        return;
    const double t = (piece.plane - glm::dot(origin, piece.normal)) / det;
    if (t <= 0 || (best && t >= best->distance))
        return;
    const glm::dvec3 rest = origin + t * direction - piece.centre;
    const double w = glm::dot(rest, piece.across);
    // across is horizontal and not square to along: solve the rest in the plane spanned by both.
    const double a = (glm::dot(rest, piece.along) - piece.skew * w) * piece.stretch;
    if (!(a >= 0 && a < 1) || std::abs(w - a * piece.skew) > piece.half + a * piece.taper)
        return;
    best = RayHit{t, item.piece, a, {}, {}};
}

/// From a piece's number and the place in it to the blade's.
void BladeField::finish(RayHit& hit) const {
    const Piece& piece = pieces_[hit.blade];
    const auto segment = static_cast<int>(hit.blade % Outline::kSegments);
    hit.blade /= Outline::kSegments;
    hit.along = outlines_[hit.blade].between(segment, hit.along);
    hit.normal = piece.normal / glm::length(piece.normal);
}

std::optional<RayHit> BladeField::cast(glm::dvec3 origin, glm::dvec3 direction,
                                       double limit) const {
    double t = 0;
    if (origin.y > canopy_) {
        if (direction.y >= 0)
            return std::nullopt;
        t = (canopy_ - origin.y) / direction.y;
    }
    const glm::dvec3 start = origin + t * direction;
    double end = direction.y < 0 ? std::min(limit, -origin.y / direction.y) : limit;
    if (direction.y > 0)
        end = std::min(end, t + (top_ - start.y) / direction.y + 1e-6); // there is nothing above
    const double width = side_ / kCells;
    Walk x(start.x, direction.x, width), y(start.y, direction.y, layer_),
        z(start.z, direction.z, width);
    std::optional<RayHit> best;
    const glm::vec3 way(direction);
    double entry = 0; // along the ray from `start`
    while (t + entry < end) {
        const double exit = std::min({x.next, y.next, z.next});
        const glm::dvec3 tile(tile_of(x.cell), 0, tile_of(z.cell));
        const glm::vec3 here(start + entry * direction - side_ * tile);
        const auto through = static_cast<float>(std::min(exit, kFar) - entry);
        for (const Item& item : cell(x.cell, y.cell, z.cell)) {
            const glm::vec3 to = item.middle - here;
            const float along = glm::dot(to, way);
            if (along > -item.radius && along < through + item.radius &&
                glm::dot(to, to) - along * along < item.radius * item.radius)
                meet(item, start - side_ * (tile + glm::dvec3(item.tile_x, 0, item.tile_z)),
                     direction, best);
        }
        if (best && best->distance <= exit)
            break;
        entry = exit;
        (exit == x.next ? x : exit == y.next ? y : z).advance();
    }
    if (!best || t + best->distance >= end)
        return std::nullopt;
    finish(*best);
    best->distance += t;
    best->position = origin + best->distance * direction;
    return best;
}

SampleRay sample_ray(int number, double elevation_deg, double side, double canopy) {
    const double elevation = elevation_deg * base::kDegree;
    const int n = number + 1; // 0 is the corner of all bases
    const double azimuth = halton(n, 5) * 2 * std::numbers::pi;
    return {glm::dvec3(halton(n, 2) * side, canopy, halton(n, 3) * side),
            glm::dvec3(std::cos(elevation) * std::cos(azimuth), -std::sin(elevation),
                       std::cos(elevation) * std::sin(azimuth))};
}

} // namespace sward::texgen
