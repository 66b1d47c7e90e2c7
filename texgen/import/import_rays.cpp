// SPDX-License-Identifier: Apache-2.0
// Rays through voxels, at rest and bent.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "base/hash.h"
#include "shared/bend.h"
#include "shared/shading.h"
#include "texgen/import/import_field.h"
#include "texgen/patch/rays.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

constexpr double kClear = 1e-3; // what is left of a ray when it is given up

/// Share of what a ray still sees, strand by strand: pieces of one blade lie beside each other and
/// add up, different blades hide each other by chance.
class Sight {
public:
    /// What the voxel takes of the sight.
    double take(std::uint32_t strand, double share) {
        Part* part = nullptr;
        for (Part& p : parts_)
            if (p.strand == strand && p.sum > 0)
                part = &p;
        if (!part) {
            part = &parts_[next_++ % parts_.size()];
            gone_ *= 1 - part->sum;
            *part = {strand, 0};
        }
        const double before = left();
        part->sum = std::min(1.0, part->sum + share);
        return before - left();
    }
    [[nodiscard]] double left() const {
        double left = gone_;
        for (const Part& p : parts_)
            left *= 1 - p.sum;
        return left;
    }

private:
    struct Part {
        std::uint32_t strand = 0;
        double sum = 0;
    };
    std::array<Part, 4> parts_;
    unsigned next_ = 0;
    double gone_ = 1;
};

int wrap(int i, int n) {
    const int r = i % n;
    return r < 0 ? r + n : r;
}

/// The field bent along +x by the warp of its shell images (B3). That moves every point of a height
/// alike: so it is a pile of rigid rows, shifted and pressed together.
class BentVoxels {
public:
    BentVoxels(const VoxelField& field, double lean) : field_(field) {
        const auto canopy = static_cast<float>(field.canopy());
        // The wind of 1 m/s along x whose bend_intensity is `lean`.
        const auto response = static_cast<float>(std::sqrt(std::pow(1 - lean, -1.5) - 1));
        const glm::vec2 wind(lean > 0 ? 1 : 0, 0);
        const int rows = field.volume().cells.y;
        for (int y = 0; y <= rows; ++y) {
            const auto edge = static_cast<float>(y * field.volume().voxel_m);
            const auto middle = static_cast<float>((y + 0.5) * field.volume().voxel_m);
            edges_.push_back(edge + shared::bend_offset(edge, canopy, wind, response).y);
            shifts_.push_back(shared::bend_offset(middle, canopy, wind, response).x);
            turns_.push_back(shared::bend_turn(middle, canopy, wind, response));
        }
    }

    /// The voxel that a ray meets, by a random number in [0, 1) of its own; -1: none.
    [[nodiscard]] std::int64_t meet(const SampleRay& ray, double random) const {
        Sight sight;
        Walk walk{ray, glm::vec3(ray.direction), random, sight, 1, -1};
        for (int y = field_.volume().cells.y - 1; y >= 0 && walk.found < 0 && walk.clear > kClear;
             --y)
            cross_row(y, walk);
        return walk.found;
    }

    [[nodiscard]] glm::vec3 tangent(std::size_t i) const {
        const glm::vec3 t = field_.tangent(i);
        return glm::normalize(glm::vec3(t.x, 0, t.z) + t.y * turns_[field_.volume().at[i].y]);
    }

private:
    struct Walk {
        const SampleRay& ray;
        glm::vec3 way;
        double random;
        Sight& sight;
        double clear;
        std::int64_t found;
    };

    void cross_row(int y, Walk& walk) const {
        const auto row = static_cast<std::size_t>(y);
        const double voxel = field_.volume().voxel_m;
        const SampleRay& ray = walk.ray;
        const double begin = std::max(0.0, (edges_[row + 1] - ray.origin.y) / ray.direction.y);
        const double end = (edges_[row] - ray.origin.y) / ray.direction.y;
        if (!(end > begin))
            return;
        // Pressed rows hold the same area in less height.
        const double dense = voxel / (edges_[row + 1] - edges_[row]);
        glm::dvec2 p(ray.origin.x + begin * ray.direction.x - shifts_[row],
                     ray.origin.z + begin * ray.direction.z);
        p /= voxel;
        const glm::dvec2 d(ray.direction.x / voxel, ray.direction.z / voxel);
        glm::ivec2 cell(glm::floor(p));
        glm::dvec2 next, delta;
        for (int a = 0; a < 2; ++a) {
            delta[a] = std::abs(d[a]) > 1e-9 ? 1 / std::abs(d[a]) : 1e30;
            next[a] =
                std::abs(d[a]) > 1e-9 ? begin + (cell[a] + (d[a] > 0 ? 1 : 0) - p[a]) / d[a] : 1e30;
        }
        double at = begin;
        while (at < end && walk.found < 0 && walk.clear > kClear) {
            const int a = next.x < next.y ? 0 : 1;
            const double stop = std::min(end, next[a]);
            visit(cell, y, (stop - at) / voxel * dense, walk);
            at = stop;
            next[a] += delta[a];
            cell[a] += d[a] > 0 ? 1 : -1;
        }
    }

    /// `length`: of the ray's way through the cell, in voxels.
    void visit(glm::ivec2 cell, int y, double length, Walk& walk) const {
        const glm::ivec3 cells = field_.volume().cells;
        const std::int64_t n = field_.index().at(wrap(cell.x, cells.x), y, wrap(cell.y, cells.z));
        if (n < 0 || length <= 0)
            return;
        const auto i = static_cast<std::size_t>(n);
        if (field_.blades()) {
            const float seen =
                field_.density(i) * std::abs(glm::dot(field_.normal(i, tangent(i)), walk.way));
            const double others = field_.others(i);
            walk.sight.take(field_.strand(i), seen * length * (1 - others));
            if (others > 0)
                walk.sight.take(VoxelField::beside(field_.strand(i)), seen * length * others);
            walk.clear = walk.sight.left();
        } else {
            walk.clear *= std::pow(1 - field_.seen_along(i, walk.way), length);
        }
        if (1 - walk.clear > walk.random)
            walk.found = n;
    }

    const VoxelField& field_;
    std::vector<double> edges_;  ///< heights of the rows' edges, bent
    std::vector<double> shifts_; ///< of the rows along x
    std::vector<glm::vec3> turns_;
};

} // namespace

Canopy volume_canopy(const VoxelField& field, const shared::GrassAppearance& look) {
    Canopy canopy;
    canopy.side_m = field.side();
    canopy.top_m = field.canopy();
    canopy.looks = {look};
    canopy.bent = [&field, &look](double lean) {
        const auto bent = std::make_shared<const BentVoxels>(field, lean);
        return std::vector<Caster>{[&field, &look,
                                    bent](const SampleRay& ray,
                                          std::uint64_t number) -> std::optional<GrassHit> {
            const std::int64_t n = bent->meet(ray, base::hash_unit(17, 0, number));
            if (n < 0)
                return std::nullopt;
            const auto i = static_cast<std::size_t>(n);
            const shared::vec2 id((static_cast<float>(field.rank8(i)) + 0.5f) / 256,
                                  (static_cast<float>(field.seed8(i)) + 0.5f) / 256);
            const glm::vec3 albedo =
                field.coloured() ? field.colour(i)
                                 : glm::vec3(shared::blade_albedo(look, id, field.along(i), 0));
            return GrassHit{albedo, bent->tangent(i),
                            std::min(1.0, field.centre(i).y / field.canopy()), field.along(i), 0};
        }};
    };
    return canopy;
}

std::vector<double> heights_seen(const VoxelField& field, int threads) {
    constexpr std::array kViews = {75.0, 60.0, 45.0}; // where shells count beside the slices
    constexpr std::size_t kEach = 4096;
    const BentVoxels rest(field, 0);
    std::vector<double> heights(kViews.size() * kEach, -1);
    parallel_for(heights.size(), resolve_threads(threads), [&](std::size_t task, int) {
        const SampleRay ray = sample_ray(static_cast<int>(task % kEach), kViews[task / kEach],
                                         field.side(), field.canopy());
        if (const std::int64_t n = rest.meet(ray, base::hash_unit(11, 0, task)); n >= 0)
            heights[task] = field.centre(static_cast<std::size_t>(n)).y;
    });
    std::erase_if(heights, [](double h) { return h < 0; });
    std::ranges::sort(heights);
    return heights;
}

} // namespace sward::texgen
