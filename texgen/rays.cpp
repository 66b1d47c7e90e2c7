// SPDX-License-Identifier: Apache-2.0
#include "texgen/rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sward::texgen {
namespace {

constexpr int kCells = 64;

int floor_mod(int a, int b) {
    const int r = a % b;
    return r < 0 ? r + b : r;
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
    : side_(side), canopy_(canopy), cells_(kCells), outlines_(outlines_of(blades, species)),
      grid_(kCells * kCells) {
    for (std::uint32_t b = 0; b < outlines_.size(); ++b)
        for (int i = 0; i < Outline::kSegments; ++i)
            bin(b, i);
}

void BladeField::bin(std::uint32_t blade, int segment) {
    const Outline& o = outlines_[blade];
    glm::dvec3 low(1e30), high(-1e30);
    for (const int i : {segment, segment + 1})
        for (const double sign : {-1.0, 1.0}) {
            low = glm::min(low, o.centre[i] + sign * o.half[i] * o.across);
            high = glm::max(high, o.centre[i] + sign * o.half[i] * o.across);
        }
    const auto index = [&](double v) { return static_cast<int>(std::floor(v / side_ * cells_)); };
    const auto tile = [&](int c) { return (c - floor_mod(c, cells_)) / cells_; };
    for (int z = index(low.z - 1e-9); z <= index(high.z + 1e-9); ++z)
        for (int x = index(low.x - 1e-9); x <= index(high.x + 1e-9); ++x)
            grid_[static_cast<std::size_t>(floor_mod(z, cells_) * cells_ + floor_mod(x, cells_))]
                .push_back({blade, static_cast<float>(low.y - 1e-6),
                            static_cast<float>(high.y + 1e-6), static_cast<std::uint8_t>(segment),
                            static_cast<std::int8_t>(-tile(x)),
                            static_cast<std::int8_t>(-tile(z))});
}

const std::vector<BladeField::Item>& BladeField::cell(int x, int z) const {
    return grid_[static_cast<std::size_t>(floor_mod(z, cells_) * cells_ + floor_mod(x, cells_))];
}

void BladeField::meet(const Item& item, glm::dvec3 origin, glm::dvec3 direction,
                      std::optional<RayHit>& best) const {
    const Outline& o = outlines_[item.blade];
    const int i = item.segment;
    const glm::dvec3 along = o.centre[i + 1] - o.centre[i];
    // origin + t direction = centre + a along + w across: a 3 x 3 system by Cramer's rule.
    const glm::dvec3 normal = glm::cross(along, o.across);
    const double det = glm::dot(direction, normal);
    if (std::abs(det) < 1e-15)
        return;
    const glm::dvec3 from = o.centre[i] - origin;
    const double t = glm::dot(from, normal) / det;
    if (t <= 0 || (best && t >= best->distance))
        return;
    const glm::dvec3 rest = t * direction - from;
    const double w = glm::dot(rest, o.across);
    // across is horizontal and not square to along: solve the rest in the plane spanned by both.
    const double ab = glm::dot(along, o.across), aa = glm::dot(along, along);
    const double a = (glm::dot(rest, along) - ab * w) / (aa - ab * ab);
    if (!(a >= 0 && a < 1))
        return;
    const double offset = w - a * ab;
    if (std::abs(offset) > o.half[i] + a * (o.half[i + 1] - o.half[i]))
        return;
    best = RayHit{t, item.blade, o.between(i, a), {}, normal / glm::length(normal)};
}

std::optional<RayHit> BladeField::cast(glm::dvec3 origin, glm::dvec3 direction,
                                       double limit) const {
    double t = 0;
    if (origin.y > canopy_) {
        if (direction.y >= 0)
            return std::nullopt;
        t = (canopy_ - origin.y) / direction.y;
    }
    const double end = direction.y < 0 ? std::min(limit, -origin.y / direction.y) : limit;
    const double width = side_ / cells_;
    const glm::dvec3 start = origin + t * direction;
    Walk x(start.x, direction.x, width), z(start.z, direction.z, width);
    std::optional<RayHit> best;
    double entry = 0; // along the ray from `start`
    while (t + entry < end) {
        const int tile_x = (x.cell - floor_mod(x.cell, cells_)) / cells_,
                  tile_z = (z.cell - floor_mod(z.cell, cells_)) / cells_;
        const double exit = std::min(x.next, z.next);
        const double y0 = start.y + entry * direction.y,
                     y1 = start.y + std::min(exit, 1e6) * direction.y;
        for (const Item& item : cell(x.cell, z.cell)) {
            if (item.low > std::max(y0, y1) || item.high < std::min(y0, y1))
                continue;
            const glm::dvec3 shift((tile_x + item.shift_x) * side_, 0.0,
                                   (tile_z + item.shift_z) * side_);
            meet(item, start - shift, direction, best);
        }
        if (best && best->distance <= exit)
            break;
        entry = exit;
        (x.next < z.next ? x : z).advance();
    }
    if (!best || t + best->distance >= end)
        return std::nullopt;
    best->distance += t;
    best->position = origin + best->distance * direction;
    return best;
}

SampleRay sample_ray(int number, double elevation_deg, double side, double canopy) {
    const double elevation = elevation_deg * std::numbers::pi / 180;
    const int n = number + 1; // 0 is the corner of all bases
    const double azimuth = halton(n, 5) * 2 * std::numbers::pi;
    return {glm::dvec3(halton(n, 2) * side, canopy, halton(n, 3) * side),
            glm::dvec3(std::cos(elevation) * std::cos(azimuth), -std::sin(elevation),
                       std::cos(elevation) * std::sin(azimuth))};
}

} // namespace sward::texgen
