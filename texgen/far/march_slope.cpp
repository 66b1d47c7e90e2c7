// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/march_slope.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "shared/blade.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

constexpr double kSlope = 0.5;   // of MarchMedium::slopes, metres a metre
constexpr int kSlopeRays = 8000; // of a view, at most
constexpr double kLowest = 1.5;  // elevation: rays along the ground have no end

/// Blades of one variant over ground that rises along x, in heights over that ground.
class SlopedBlades {
public:
    SlopedBlades(const Patch& patch, int variant, double canopy, double slope)
        : rest_(patch.variant(variant)), canopy_(canopy) {
        std::vector<shared::BladeRecord> leant(rest_.begin(), rest_.end());
        double top = canopy;
        for (shared::BladeRecord& blade : leant) {
            for (shared::vec4* point : {&blade.v1, &blade.v2}) {
                point->y -= static_cast<float>(slope) * point->x;
                top = std::max(top, 1.1 * static_cast<double>(point->y));
            }
        }
        top_ = top;
        field_.emplace(leant, patch.looks, patch.side_m, top);
    }
    [[nodiscard]] double top() const { return top_; }
    /// What a ray meets: its height at rest, over the canopy's; how far it leans against the ray's
    /// way over the ground (sine).
    [[nodiscard]] std::optional<glm::dvec2> meet(const SampleRay& ray) const {
        const std::optional<RayHit> hit = field_->cast(ray.origin, ray.direction);
        if (!hit)
            return std::nullopt;
        const shared::BladeRecord& own = rest_[hit->blade];
        const glm::vec3 v1(own.v1), v2(own.v2);
        const auto v = static_cast<float>(hit->along);
        const glm::dvec3 tangent = shared::blade_tangent(v1, v2, v);
        return glm::dvec2(shared::blade_curve(v1, v2, v).y / canopy_,
                          (tangent.y < 0 ? tangent.x : -tangent.x) *
                              (ray.direction.x < 0 ? -1 : 1));
    }

private:
    std::span<const shared::BladeRecord> rest_;
    double canopy_, top_ = 0;
    std::optional<BladeField> field_;
};

/// Mean of what rays meet that go along x, up (`way` 1) or down (-1) the slope.
glm::dvec2 mean_of(const std::vector<SlopedBlades>& variants, const Patch& patch,
                   double elevation_deg, double way, int rays) {
    const double elevation = elevation_deg * base::kDegree;
    glm::dvec2 sum(0);
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        const SlopedBlades& blades = variants[static_cast<std::size_t>(i) * variants.size() /
                                              static_cast<std::size_t>(rays)];
        SampleRay ray = sample_ray(i, elevation_deg, patch.side_m, blades.top());
        ray.direction = {way * std::cos(elevation), -std::sin(elevation), 0};
        if (const auto met = blades.meet(ray)) {
            sum += *met;
            ++hits;
        }
    }
    return sum / static_cast<double>(std::max(hits, 1));
}

} // namespace

void fit_slopes(const Patch& patch, int rays, int threads, shared::MarchMedium& medium) {
    std::vector<SlopedBlades> level, sloped;
    for (int v = 0; v < patch.variants(); ++v) {
        level.emplace_back(patch, v, medium.canopy_m, 0);
        sloped.emplace_back(patch, v, medium.canopy_m, kSlope);
    }
    const int count = std::min(rays, kSlopeRays);
    parallel_for(shared::kMarchElevations, resolve_threads(threads), [&](std::size_t row, int) {
        const double elevation = std::clamp(5.0 * static_cast<double>(row), kLowest, 89.9);
        const glm::dvec2 flat = 0.5 * (mean_of(level, patch, elevation, 1, count / 2) +
                                       mean_of(level, patch, elevation, -1, count / 2));
        const glm::dvec2 down = mean_of(sloped, patch, elevation, -1, count),
                         up = mean_of(sloped, patch, elevation, 1, count);
        medium.slopes[row] = glm::vec4(down.y, flat.y, up.y, up.x - flat.x);
    });
}

} // namespace sward::texgen
