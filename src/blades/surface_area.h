// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/mesh.h"

namespace sward::blades {

/// A place on a mesh.
struct SurfacePoint {
    glm::dvec3 place{0};
    std::uint32_t triangle = 0;
};

/// A mesh as something to stand on: the area that grass may cover, places uniform by area, walks
/// along the surface.
class SurfaceArea {
public:
    /// `slope_deg`: triangles that lean more are bare; 180: none is. The mesh has been checked and
    /// outlives this.
    SurfaceArea(const scene::Mesh& mesh, double slope_deg);

    [[nodiscard]] double total_m2() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
    [[nodiscard]] const scene::Mesh& mesh() const { return mesh_; }
    /// May grass stand on it?
    [[nodiscard]] bool covered(std::uint32_t triangle) const {
        return cumulative_[triangle] > (triangle > 0 ? cumulative_[triangle - 1] : 0);
    }
    /// The place that uniform u.x of the area, u.y and u.z within its triangle, in [0, 1) each,
    /// fall on (J2).
    [[nodiscard]] SurfacePoint sample(glm::dvec3 u) const;
    /// Unit normal of the surface there: between the vertices', on the triangle's own side.
    [[nodiscard]] glm::dvec3 normal(const SurfacePoint& at) const;
    /// Unit normal of the triangle.
    [[nodiscard]] glm::dvec3 face_normal(std::uint32_t triangle) const;
    /// Straight on along the surface, `by` metres in the direction `way` (made square to the
    /// triangle's normal), across edges; ends at a rim of the mesh or of what grass may cover.
    /// link_neighbours() before.
    [[nodiscard]] SurfacePoint walk(SurfacePoint from, glm::dvec3 way, double by) const;
    /// Finds which triangles share edges: places that are the same to the bit are one vertex,
    /// whatever their number.
    void link_neighbours();

    [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, int k) const {
        return glm::dvec3(mesh_.positions[mesh_.triangles[triangle][static_cast<std::size_t>(k)]]);
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    [[nodiscard]] double area(std::uint32_t triangle) const;

    const scene::Mesh& mesh_;
    std::vector<double> cumulative_; ///< area up to and with each triangle
    std::vector<std::array<std::uint32_t, 3>>
        across_; ///< triangle beyond the edge from corner k to the next
};

} // namespace sward::blades
