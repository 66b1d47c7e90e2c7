// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blades/surface_pass.h"
#include "grass/grass_set.h"
#include "render/ground.h"
#include "render/mesh_pass.h"
#include "scene/scene.h"
#include "shells/surface_canopy.h"

namespace sward::render {

/// The ground of a scene that stands on a mesh (terrain.surface), with its grass. The mesh's space
/// is the world's. Where the scene's [surface_grass] describes the blades there is no far field;
/// where it names a set, the set's patches lie on charts of the mesh.
class MeshGround final : public Ground {
public:
    /// Throws Error as blades::place_surface_grass. `set`: that its grass is of; null: the scene
    /// describes it.
    MeshGround(const scene::Mesh& mesh, const scene::Scene& scene, const grass::GrassSet* set);

    [[nodiscard]] std::unique_ptr<GroundPicture> picture(PictureContext& context) override;
    /// What the frame constants hold of a grass set, where there is none: look, canopy, width of a
    /// blade; hand-over: none, nor without a far field. Charts know no anchor.
    void describe(shared::FrameConstants& frame, glm::dvec2 anchor, bool far_field) const override;
    [[nodiscard]] bool has_far() const override { return canopy_ != nullptr; }
    [[nodiscard]] bool on_charts() const override { return true; }
    [[nodiscard]] bool far_alone() const override { return false; }
    [[nodiscard]] bool placed_for_good() const override { return true; }
    [[nodiscard]] double blade_width_m() const override { return blade_width_m_; }
    [[nodiscard]] bool has_blades() const override { return true; }
    [[nodiscard]] blades::LivingBlades* living() override { return simulation_.get(); }
    void make_living(const blades::LivingBlades::Settings& settings) override {
        simulation_ = grass_.simulation(settings);
    }
    void add_stats(FrameStats& stats) const override { stats.surface_bytes = grass_.bytes(); }
    [[nodiscard]] CullCounts cull_counts(bool /*sampled*/) const override {
        return grass_.cull().counts();
    }
    void reload(std::vector<std::string>& failures) override;

private:
    friend class MeshPicture;
    /// How the mesh itself is drawn, its origin at `origin` (anchor-relative).
    [[nodiscard]] MeshPass::Look look(glm::vec3 origin) const;

    scene::SurfaceGrassSpec spec_;
    double blade_width_m_;
    MeshBuffer mesh_;
    blades::SurfacePass grass_;
    std::unique_ptr<shells::SurfaceCanopy> canopy_;         ///< of a set's grass
    std::unique_ptr<blades::SurfaceSimulation> simulation_; ///< goes before the grass
};

} // namespace sward::render
