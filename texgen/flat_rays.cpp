// SPDX-License-Identifier: Apache-2.0
#include "texgen/flat_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"

namespace sward::texgen {
namespace {

int wrapped(double metres, double texel, int count) {
    const int i = static_cast<int>(std::floor(metres / texel)) % count;
    return i < 0 ? i + count : i;
}

const std::uint8_t* texel_of(const grass::TextureArray& array, int image, int column, int row) {
    const auto w = static_cast<std::size_t>(array.width),
               h = static_cast<std::size_t>(array.height);
    return array.mips[0].data() +
           4 * ((static_cast<std::size_t>(image) * h + static_cast<std::size_t>(row)) * w +
                static_cast<std::size_t>(column));
}

} // namespace

std::optional<FlatHit> FlatField::cast(glm::dvec3 origin, glm::dvec3 direction,
                                       std::uint64_t ray) const {
    const Ray r{origin, direction, std::max(0.0, (set_.canopy_m - origin.y) / direction.y),
                -origin.y / direction.y, ray};
    std::optional<FlatHit> best;
    if (use_.shell_share > 0)
        shells(r, best);
    if (use_.slice_share > 0)
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            slices(r, axis, best);
    return best;
}

void FlatField::shells(const Ray& ray, std::optional<FlatHit>& best) const {
    const double texel = static_cast<double>(set_.side_m) / far_.layers.width;
    for (int i = far_.layer_count - 1; i >= 0; --i) {
        const double y = (i + 0.5) / far_.layer_count * set_.canopy_m;
        const double t = (y - ray.origin.y) / ray.direction.y;
        if (t < ray.begin)
            continue;
        const glm::dvec3 p = ray.origin + t * ray.direction;
        const std::uint8_t* id = texel_of(
            far_.layers, shared::layer_index(variant_, i, far_.layer_count, shared::kPlaneId),
            wrapped(p.x, texel, far_.layers.width), wrapped(p.z, texel, far_.layers.width));
        const double seed = (id[2] + 0.5) / 256;
        if (1 - seed < use_.shell_share &&
            base::hash_unit(ray.number, 0, static_cast<std::uint64_t>(i)) * 255 < id[0]) {
            best = FlatHit{t, y, id[3] / 255.0};
            return;
        }
    }
}

void FlatField::slices(const Ray& ray, int axis, std::optional<FlatHit>& best) const {
    const double d = axis == shared::kAxisX ? ray.direction.x : ray.direction.z;
    const double o = axis == shared::kAxisX ? ray.origin.x : ray.origin.z;
    const double flat = std::hypot(ray.direction.x, ray.direction.z);
    if (flat < 1e-9 || std::abs(d) < 1e-9)
        return;
    const double gap = static_cast<double>(set_.side_m) / far_.slice_count;
    const double texel = static_cast<double>(set_.side_m) / far_.slices.width;
    const double from = (o + ray.begin * d) / gap - 0.5;
    const int step = d > 0 ? 1 : -1;
    for (int m = static_cast<int>(d > 0 ? std::ceil(from) : std::floor(from));; m += step) {
        const double t = ((m + 0.5) * gap - o) / d;
        if (t > ray.end || (best && t >= best->distance))
            return;
        const glm::dvec3 p = ray.origin + t * ray.direction;
        const int row = std::clamp(static_cast<int>(p.y / set_.canopy_m * far_.slices.height), 0,
                                   far_.slices.height - 1);
        const int slice = ((m % far_.slice_count) + far_.slice_count) % far_.slice_count;
        const std::uint8_t* id =
            texel_of(far_.slices,
                     shared::slice_index(variant_, axis, slice, far_.slice_count, shared::kPlaneId),
                     wrapped(axis == shared::kAxisX ? p.z : p.x, texel, far_.slices.width), row);
        const double seed = (id[2] + 0.5) / 256;
        if (seed < use_.slice_share * std::abs(d) / flat &&
            base::hash_unit(ray.number, static_cast<std::uint64_t>(1 + axis),
                            static_cast<std::uint64_t>(m + (1 << 20))) *
                    255 <
                id[0]) {
            best = FlatHit{t, p.y, id[3] / 255.0};
            return;
        }
    }
}

grass::FarRow flat_coverage(const grass::GrassSet& set, int level, double elevation_deg,
                            FlatUse use, int rays) {
    const double elevation = elevation_deg * std::numbers::pi / 180;
    double hits = 0, height = 0, along = 0;
    for (int i = 0; i < rays; ++i) {
        const auto number = static_cast<std::uint64_t>(i);
        const FlatField field(set, i % set.variants, level, use);
        const double azimuth = base::hash_unit(9, 1, number) * 2 * std::numbers::pi;
        const glm::dvec3 origin(base::hash_unit(9, 2, number) * set.side_m, set.canopy_m,
                                base::hash_unit(9, 3, number) * set.side_m);
        const glm::dvec3 direction(std::cos(elevation) * std::cos(azimuth), -std::sin(elevation),
                                   std::cos(elevation) * std::sin(azimuth));
        if (const auto hit = field.cast(origin, direction, number)) {
            hits += 1;
            height += hit->height / set.canopy_m;
            along += hit->along;
        }
    }
    return {static_cast<float>(elevation_deg), static_cast<float>(hits / rays),
            static_cast<float>(height / std::max(hits, 1.0)),
            static_cast<float>(along / std::max(hits, 1.0))};
}

} // namespace sward::texgen
