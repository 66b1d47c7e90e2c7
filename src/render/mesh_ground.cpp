// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_ground.h"

#include <cmath>

#include "base/angles.h"
#include "blades/surface_placement.h"
#include "render/ground_picture.h"
#include "render/pass_names.h"
#include "render/reload.h"

namespace sward::render {

namespace {

constexpr float kNoHandover_m = 1e6f; // geometry at every distance
constexpr float kApart = 0.004f; // canopies: nearer along a ray, two surfaces of a mesh are one

} // namespace

/// The mesh and its blades, page by page of their clusters.
class MeshPicture final : public GroundPicture {
public:
    MeshPicture(PictureContext& context, MeshGround& ground)
        : GroundPicture(context), ground_(ground) {}

    void begin() override { parts_.clear(); }
    [[nodiscard]] bool has_blocks() const override { return false; }

    [[nodiscard]] const char* draw_name() const override { return pass_names::kSurface; }
    void draw() override { at_.passes.meshes.execute(ground_.mesh_, ground_.look(origin())); }

    void select_blades() override {
        ground_.grass_.limit(at_.shot.constants.lod_eye, at_.shot.constants.handover_band.y);
        parts_ = ground_.grass_.select(at_.frustum(), origin());
        part_ = batch_ = 0;
        counts_on_ = at_.view.blades_considered > 0;
        for (const blades::SurfacePass::Part& part : parts_) {
            at_.view.blades_considered += part.list.considered;
        }
    }

    bool next_batch() override {
        if (part_ < parts_.size() && batch_ == blades::CullPass::batches_of(parts_[part_].list)) {
            ++part_;
            batch_ = 0;
        }
        return part_ < parts_.size() && ++batch_ > 0;
    }

    void cull_batch() override {
        const blades::CullTests tests = at_.tests();
        if (batch_ == 1) {
            ground_.grass_.begin(parts_[part_], {origin(), tests.distance, counts_on_}, drawn());
            counts_on_ = true;
        }
        ground_.grass_.cull(batch_ - 1, tests);
    }

    void draw_batch() override {
        if (at_.living()) {
            ground_.simulation_->bind_for_drawing(); // where the culling had its own
        }
        drawn().execute(ground_.grass_.cull());
    }

    void draw_canopy() override {
        at_.view.surface_canopy.require(at_.settings.width, at_.settings.height);
        at_.field.march_textures.bind(); // the canopy's height knows how far its blades lean
        at_.passes.march.draw_surface(at_.view.surface_canopy, *ground_.canopy_, origin(),
                                      kApart * at_.field.world.grass.canopy_m);
    }

    [[nodiscard]] shells::MarchPass::Inputs march_inputs() const override {
        return {at_.field.march_textures,   at_.view.surface_canopy.first,
                &at_.view.surface_canopy,   origin(),
                at_.view.targets.samples(), 0};
    }

private:
    [[nodiscard]] glm::vec3 origin() const { return glm::vec3(-at_.shot.anchor); }
    [[nodiscard]] blades::DrawPass& drawn() { return at_.passes.surface(at_.settings.aov); }

    MeshGround& ground_;
    std::vector<blades::SurfacePass::Part> parts_;
    std::size_t part_ = 0, batch_ = 0; ///< one more than the batch of the part in the making
    bool counts_on_ = false;           ///< from what was drawn of this frame before
};

MeshGround::MeshGround(const scene::Mesh& mesh, const scene::Scene& scene,
                       const grass::GrassSet* set)
    : spec_(scene.surface_grass),
      blade_width_m_(set ? mean_blade_width_m(*set) : spec_.species.width_m.mean()), mesh_(mesh),
      grass_(set ? blades::place_set_on_surface(mesh, {*set, scene.grass.density, spec_.slope_deg},
                                                scene.terrain.surface)
                 : blades::place_surface_grass(mesh, spec_, scene.terrain.surface),
             spec_, set),
      canopy_(set ? std::make_unique<shells::SurfaceCanopy>(mesh, spec_.slope_deg) : nullptr) {}

std::unique_ptr<GroundPicture> MeshGround::picture(PictureContext& context) {
    return std::make_unique<MeshPicture>(context, *this);
}

MeshPass::Look MeshGround::look(glm::vec3 origin) const {
    MeshPass::Look look;
    look.place = origin;
    look.colour = glm::vec3(spec_.ground_colour);
    look.tier = 0;
    look.bare = glm::vec3(spec_.bare_colour);
    look.least_up = spec_.slope_deg >= 180
                        ? -2.0f
                        : static_cast<float>(std::cos(spec_.slope_deg * base::kDegree));
    look.density = 1;
    return look;
}

void MeshGround::describe(shared::FrameConstants& frame, glm::dvec2 /*anchor*/,
                          bool far_field) const {
    if (!has_far() || !far_field) {
        frame.handover_band = {kNoHandover_m, 1.001f * kNoHandover_m};
    }
    if (has_far()) {
        frame.patch_offset_m = glm::vec2(0);
        frame.anchor_tile = glm::ivec2(0);
        return;
    }
    frame.looks[0] = scene::appearance(spec_.species);
    frame.canopy_m = static_cast<float>(spec_.species.length_m.high);
    frame.blade_width_m = static_cast<float>(blade_width_m_);
}

void MeshGround::reload(std::vector<std::string>& failures) {
    render::reload(&grass_, failures);
    render::reload(simulation_ ? &simulation_->pass() : nullptr, failures);
}

} // namespace sward::render
