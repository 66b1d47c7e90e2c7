// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "grass/grass_set.h"

namespace sward::texgen {

/// Where a ray meets one of the flat textures.
struct FlatHit {
    double distance = 0;
    double height = 0; ///< metres
    double along = 0;
};

/// What part of the far tier counts.
struct FlatUse {
    double shell_share =
        1; ///< shells show a blade while 1 - seed < share; above 1 it scales their coverage
    double slice_share = 1; ///< scales the slices' |dx| and |dz|
};

/// The far tier as rays see it: shells and both slice families of one level at rest, as models of
/// the renderer and for calibration. A slice across x shows a blade while seed < |dx|, one across z
/// while seed < |dz| (design, section 1).
class FlatField {
public:
    FlatField(const grass::GrassSet& set, int variant, int level, FlatUse use)
        : set_(set), far_(set.levels[static_cast<std::size_t>(level)]), variant_(variant),
          use_(use) {}

    /// `ray` numbers the random stream that turns a texel's coverage into hit or miss. `direction`
    /// points down.
    [[nodiscard]] std::optional<FlatHit> cast(glm::dvec3 origin, glm::dvec3 direction,
                                              std::uint64_t ray) const;

    /// Least shell share at which the ray meets a texture, 0 if it meets a slice; infinite if it
    /// meets nothing at any share.
    [[nodiscard]] double share_needed(glm::dvec3 origin, glm::dvec3 direction,
                                      std::uint64_t ray) const;

private:
    struct Ray {
        glm::dvec3 origin, direction;
        double begin, end; ///< where it is inside the canopy
        std::uint64_t number;
    };
    [[nodiscard]] Ray ray_of(glm::dvec3 origin, glm::dvec3 direction, std::uint64_t number) const;
    /// Calls visit(hit, share) for every texel of a shell that the ray meets at that shell share or
    /// more, from the top down, until true.
    template<typename Visit> void walk_shells(const Ray& ray, const Visit& visit) const;
    /// Of a height map (B1): height of the blade in metres; 1 where a shell at height y shows it;
    /// place along it there.
    [[nodiscard]] double top_of(std::uint8_t code) const;
    [[nodiscard]] double column_chance(std::uint8_t code, double y) const;
    [[nodiscard]] double along_at(const std::uint8_t* id, double y) const;
    void shells(const Ray& ray, std::optional<FlatHit>& best) const;
    void slices(const Ray& ray, int axis, std::optional<FlatHit>& best) const;

    const grass::GrassSet& set_;
    const grass::FarLevel& far_;
    int variant_;
    FlatUse use_;
};

/// What rays meet of the textures at an elevation; the same rays as the far table's (sample_ray).
[[nodiscard]] grass::FarRow flat_coverage(const grass::GrassSet& set, int level,
                                          double elevation_deg, FlatUse use, int rays);

/// share_needed of `rays` rays at the row's elevation and share of the slices, rising: the
/// textures' coverage at a shell share is the part of the list that does not exceed it.
[[nodiscard]] std::vector<float> shares_needed(const grass::GrassSet& set, int level,
                                               const grass::FarRow& row, int rays);

} // namespace sward::texgen
