// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "texgen/canopy.h"

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
    struct Item {
        std::uint32_t blade;
        float low, high; ///< of the segment's y
        std::uint8_t segment;
        std::int8_t shift_x, shift_z; ///< image of the torus that reaches into the cell
    };

    void bin(std::uint32_t blade, int segment);
    void meet(const Item& item, glm::dvec3 origin, glm::dvec3 direction,
              std::optional<RayHit>& best) const;
    [[nodiscard]] const std::vector<Item>& cell(int x, int z) const;

    double side_;
    double canopy_;
    int cells_;
    std::vector<Outline> outlines_;
    std::vector<std::vector<Item>> grid_;
};

/// Ray `number` of a sequence that spreads evenly over places and azimuths, from the canopy's top
/// down at an elevation.
struct SampleRay {
    glm::dvec3 origin, direction;
};
[[nodiscard]] SampleRay sample_ray(int number, double elevation_deg, double side, double canopy);

} // namespace sward::texgen
