// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/flat_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "shared/blade.h"
#include "shared/grass_layout.h"
#include "texgen/patch/rays.h"

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

/// Chance that a ray along `direction` sees the texel: its coverage, put right for being flattened
/// onto the plane. `axis` is the slices', or -1 for a layer.
double chance(const std::uint8_t* id, const std::uint8_t* shape, int axis,
              const glm::dvec3& direction) {
    if (id[0] == 0)
        return 0;
    const glm::vec3 tangent = shared::decode_tangent(glm::vec2(shape[0], shape[1]) / 255.0f);
    glm::vec3 flattened = tangent;
    flattened[axis < 0 ? 1 : axis == shared::kAxisX ? 0 : 2] = 0;
    return id[0] / 255.0 * shared::flattening(tangent, flattened, -glm::vec3(direction));
}

/// Variants in blocks of consecutive rays, each of them spread evenly.
int variant_of(int ray, int rays, const grass::GrassSet& set) {
    return static_cast<int>(std::int64_t{ray} * set.variants / rays);
}

} // namespace

FlatField::Ray FlatField::ray_of(glm::dvec3 origin, glm::dvec3 direction,
                                 std::uint64_t number) const {
    return {origin, direction, std::max(0.0, (set_.canopy_m - origin.y) / direction.y),
            -origin.y / direction.y, number};
}

double FlatField::top_of(std::uint8_t code) const {
    return shared::decode_height(static_cast<float>(code) / 255.0f, set_.height_coding) *
           set_.canopy_m;
}

double FlatField::column_chance(std::uint8_t code, double y) const {
    return code > 0 && top_of(code) >= y ? 1 : 0;
}

double FlatField::along_at(const std::uint8_t* id, double y) const {
    const double along = shared::decode_along(id[3]);
    return set_.height_coding == shared::kHeightNone ? along : along * y / top_of(id[0]);
}

std::optional<FlatHit> FlatField::cast(glm::dvec3 origin, glm::dvec3 direction,
                                       std::uint64_t ray) const {
    const Ray r = ray_of(origin, direction, ray);
    std::optional<FlatHit> best;
    if (use_.shell_share > 0)
        shells(r, best);
    if (use_.slice_share > 0)
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            slices(r, axis, best);
    return best;
}

double FlatField::share_needed(glm::dvec3 origin, glm::dvec3 direction, std::uint64_t ray) const {
    const Ray r = ray_of(origin, direction, ray);
    std::optional<FlatHit> side;
    for (const int axis : {shared::kAxisX, shared::kAxisZ})
        if (!side)
            slices(r, axis, side);
    if (side)
        return 0;
    double least = std::numeric_limits<double>::infinity();
    walk_shells(r, [&](const FlatHit&, double share) {
        least = std::min(least, share);
        return false;
    });
    return least;
}

template<typename Visit> void FlatField::walk_shells(const Ray& ray, const Visit& visit) const {
    const double texel = static_cast<double>(set_.side_m) / far_.layers.width;
    for (int i = far_.layer_count - 1; i >= 0; --i) {
        const double y = far_.layer_heights[static_cast<std::size_t>(i)];
        const double t = (y - ray.origin.y) / ray.direction.y;
        if (t < ray.begin)
            continue;
        const glm::dvec3 p = ray.origin + t * ray.direction;
        const auto plane = [&](int which) {
            return texel_of(far_.layers, grass::layer_image(set_, far_, variant_, i, which),
                            wrapped(p.x, texel, far_.layers.width),
                            wrapped(p.z, texel, far_.layers.width));
        };
        const std::uint8_t* id = plane(shared::kPlaneId);
        const double odds = set_.height_coding == shared::kHeightNone
                                ? chance(id, plane(shared::kPlaneShape), -1, ray.direction)
                                : column_chance(id[0], y);
        if (odds <= 0)
            continue;
        const double lot = base::hash_unit(ray.number, 0, static_cast<std::uint64_t>(i));
        const double seed = (id[2] + 0.5) / 256;
        // Below 1 the share picks blades by seed (a step above 1 - seed shows it); above, it scales
        // their coverage.
        const double share = lot < odds ? 1 - seed + 0.5 / 256 : lot / odds;
        if (share <= grass::kMaxShellShare && visit(FlatHit{t, y, along_at(id, y)}, share))
            return;
    }
}

void FlatField::shells(const Ray& ray, std::optional<FlatHit>& best) const {
    walk_shells(ray, [&](const FlatHit& hit, double share) {
        if (share <= use_.shell_share)
            best = hit;
        return best.has_value();
    });
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
        const auto plane = [&](int which) {
            return texel_of(
                far_.slices, shared::slice_index(variant_, axis, slice, far_.slice_count, which),
                wrapped(axis == shared::kAxisX ? p.z : p.x, texel, far_.slices.width), row);
        };
        const std::uint8_t* id = plane(shared::kPlaneId);
        const double seed = (id[2] + 0.5) / 256;
        if (seed < use_.slice_share * std::abs(d) / flat &&
            base::hash_unit(ray.number, static_cast<std::uint64_t>(1 + axis),
                            static_cast<std::uint64_t>(m + (1 << 20))) <
                chance(id, plane(shared::kPlaneShape), axis, ray.direction)) {
            best = FlatHit{t, p.y, shared::decode_along(id[3])};
            return;
        }
    }
}

grass::FarRow flat_coverage(const grass::GrassSet& set, int level, double elevation_deg,
                            FlatUse use, int rays) {
    double hits = 0, height = 0, along = 0;
    for (int i = 0; i < rays; ++i) {
        const FlatField field(set, variant_of(i, rays, set), level, use);
        const SampleRay ray = sample_ray(i, elevation_deg, set.side_m, set.canopy_m);
        if (const auto hit = field.cast(ray.origin, ray.direction, static_cast<std::uint64_t>(i))) {
            hits += 1;
            height += hit->height / set.canopy_m;
            along += hit->along;
        }
    }
    grass::FarRow row;
    row.elevation_deg = static_cast<float>(elevation_deg);
    row.coverage = static_cast<float>(hits / rays);
    row.height = static_cast<float>(height / std::max(hits, 1.0));
    row.along = static_cast<float>(along / std::max(hits, 1.0));
    row.shell_share = static_cast<float>(use.shell_share);
    return row;
}

std::vector<float> shares_needed(const grass::GrassSet& set, int level, const grass::FarRow& row,
                                 int rays) {
    std::vector<float> needed;
    for (int i = 0; i < rays; ++i) {
        const FlatField field(set, variant_of(i, rays, set), level, {1, row.slice_share});
        const SampleRay ray = sample_ray(i, row.elevation_deg, set.side_m, set.canopy_m);
        needed.push_back(static_cast<float>(
            field.share_needed(ray.origin, ray.direction, static_cast<std::uint64_t>(i))));
    }
    std::ranges::sort(needed);
    return needed;
}

} // namespace sward::texgen
