// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blades/surface_pass.h"
#include "render/mesh_pass.h"
#include "scene/scene.h"

namespace sward::render {

/// The ground of a scene that stands on a mesh (terrain.surface), with its grass. The mesh's space is the world's.
class MeshGround {
public:
    /// Throws Error as blades::place_surface_grass.
    MeshGround(const scene::Mesh& mesh, const scene::Scene& scene);

    [[nodiscard]] const MeshBuffer& mesh() const { return mesh_; }
    [[nodiscard]] blades::SurfacePass& grass() { return grass_; }
    /// How the mesh itself is drawn, its origin at `origin` (anchor-relative).
    [[nodiscard]] MeshPass::Look look(glm::vec3 origin) const;
    /// Sets what the frame constants hold of a grass set: look, canopy, width of a blade; hand-over: none.
    void describe(shared::FrameConstants& frame) const;
    [[nodiscard]] double mean_blade_width_m() const { return 0.5 * (spec_.blade_width_m.x + spec_.blade_width_m.y); }

private:
    scene::SurfaceGrassSpec spec_;
    MeshBuffer mesh_;
    blades::SurfacePass grass_;
};

} // namespace sward::render
