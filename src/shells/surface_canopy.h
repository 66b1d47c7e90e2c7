// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "scene/mesh.h"

namespace sward::shells {

/// A corner of a mesh's canopy, as the GPU has it. 56 bytes.
struct CanopyVertex {
    glm::vec3 position{0}; ///< on the mesh
    glm::vec3 normal{0};
    glm::vec3 curve_squares{0};  ///< diagonal of the shape operator, in the mesh's space (1/m)
    glm::vec3 curve_products{0}; ///< its yz, zx, xy
    glm::vec2 chart_lift{0}; ///< chart of its triangle (shared/surface_chart.h); of the canopy's
                             ///< top: 2; of a wall: 1 at its top, 0 on the ground
};

/// Triangles of the canopy over a mesh: what grass may cover, to be lifted along the normals, and
/// walls from the ground to the top along each edge where it ends: a rim, the slope that bares it,
/// a hard edge whose sides are lifted apart. `slope_deg`: as of blades::SurfaceArea.
[[nodiscard]] std::vector<CanopyVertex> canopy_over(const scene::Mesh& mesh, double slope_deg);

/// The same on the GPU.
class SurfaceCanopy {
public:
    SurfaceCanopy(const scene::Mesh& mesh, double slope_deg);
    ~SurfaceCanopy();
    SurfaceCanopy(const SurfaceCanopy&) = delete;
    SurfaceCanopy& operator=(const SurfaceCanopy&) = delete;
    void draw() const;

private:
    gl::Buffer vertices_;
    std::uint32_t vertex_array_ = 0;
    int count_ = 0;
};

} // namespace sward::shells
