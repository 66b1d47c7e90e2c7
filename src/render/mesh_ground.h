// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blades/surface_pass.h"
#include "grass/grass_set.h"
#include "render/mesh_pass.h"
#include "scene/scene.h"
#include "shells/surface_canopy.h"

namespace sward::render {

/// The ground of a scene that stands on a mesh (terrain.surface), with its grass. The mesh's space
/// is the world's.
class MeshGround {
public:
    /// Throws Error as blades::place_surface_grass.
    /// `set`: that its grass is of; null: the scene's [surface_grass] describes it, and there is no
    /// far field.
    MeshGround(const scene::Mesh& mesh, const scene::Scene& scene, const grass::GrassSet* set);

    [[nodiscard]] const MeshBuffer& mesh() const { return mesh_; }
    [[nodiscard]] blades::SurfacePass& grass() { return grass_; }
    /// How the mesh itself is drawn, its origin at `origin` (anchor-relative).
    [[nodiscard]] MeshPass::Look look(glm::vec3 origin) const;
    /// Sets what the frame constants hold of a grass set, where there is none: look, canopy, width
    /// of a blade; hand-over: none, nor without a far field. The patches of a set lie on charts,
    /// which know no anchor.
    void describe(shared::FrameConstants& frame, bool far_field) const;
    [[nodiscard]] bool has_set() const { return canopy_ != nullptr; }
    [[nodiscard]] const shells::SurfaceCanopy& canopy() const { return *canopy_; }
    [[nodiscard]] double mean_blade_width_m() const {
        return spec_.species.width_m.mean();
    }

private:
    scene::SurfaceGrassSpec spec_;
    MeshBuffer mesh_;
    blades::SurfacePass grass_;
    std::unique_ptr<shells::SurfaceCanopy> canopy_; ///< of a set's grass
};

} // namespace sward::render
