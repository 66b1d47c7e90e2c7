// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "texgen/patch/canopy.h"

namespace sward::texgen {

/// Where a ray meets a blade.
struct RayHit {
    double distance = 0;
    std::uint32_t blade = 0;
    double along = 0;      ///< v
    glm::dvec3 position{}; ///< unwrapped
    glm::dvec3 normal{};   ///< unit, either side
};

/// Blades of one variant on the endless plane, for exact rays: the truth that textures are held to.
class BladeField {
public:
    BladeField(std::span<const shared::BladeRecord> blades,
               std::span<const shared::GrassAppearance> species, double side, double canopy);

    /// First blade that the ray meets above the ground, up to `limit` metres away. `direction` is a
    /// unit vector.
    [[nodiscard]] std::optional<RayHit> cast(glm::dvec3 origin, glm::dvec3 direction,
                                             double limit = kFar) const;

    static constexpr double kFar = 1000;

    [[nodiscard]] double canopy() const { return canopy_; }
    [[nodiscard]] double side() const { return side_; }

private:
    /// A segment of an outline as rays meet it: what does not depend on the ray, reckoned once.
    struct Piece {
        glm::dvec3 centre, along, across,
            normal;   ///< root end, to the tip end, unit width direction, their cross product
        double plane; ///< of the points in it: dot(point, normal)
        double skew, stretch; ///< dot(along, across); 1 / (|along|^2 - skew^2)
        double half, taper;   ///< half width at the root end, and how it changes to the tip end
    };
    /// A piece in a cell that it reaches into. The ball lies beside its neighbours' in memory: most
    /// pieces are passed by without being read.
    struct Item {
        glm::vec3 middle; ///< of a ball about the piece, where it reaches into the cell
        float radius;
        std::uint32_t piece;        ///< blade * kSegments + segment
        std::int8_t tile_x, tile_z; ///< image of the torus that the piece is moved by
    };

    void make_piece(const Outline& outline, int segment);
    template<class Visit> void each_cell(std::uint32_t piece, Visit&& visit) const;
    void meet(const Item& item, const glm::dvec3& origin, const glm::dvec3& direction,
              std::optional<RayHit>& best) const;
    void finish(RayHit& hit) const;
    [[nodiscard]] std::span<const Item> cell(int x, int y, int z) const;

    double side_;
    double canopy_;
    double layer_ = 1; ///< height of a cell, metres
    double top_ = 0;   ///< of all blades
    std::vector<Outline> outlines_;
    std::vector<Piece> pieces_;
    std::vector<Item> items_;          ///< cell after cell
    std::vector<std::uint32_t> first_; ///< of a cell's items; one more at the end
};

/// Ray `number` of a sequence that spreads evenly over places and azimuths, from the canopy's top
/// down at an elevation.
struct SampleRay {
    glm::dvec3 origin, direction;
};
[[nodiscard]] SampleRay sample_ray(int number, double elevation_deg, double side, double canopy);

} // namespace sward::texgen
