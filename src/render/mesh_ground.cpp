// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_ground.h"

#include <cmath>
#include <numbers>

#include "blades/surface_placement.h"

namespace sward::render {

namespace {

constexpr float kNoHandover_m = 1e6f; // geometry at every distance

} // namespace

MeshGround::MeshGround(const scene::Mesh& mesh, const scene::Scene& scene,
                       const grass::GrassSet* set)
    : spec_(scene.surface_grass), mesh_(mesh),
      grass_(set ? blades::place_set_on_surface(mesh, {*set, scene.grass.density, spec_.slope_deg},
                                                scene.terrain.surface)
                 : blades::place_surface_grass(mesh, spec_, scene.terrain.surface),
             spec_, set),
      canopy_(set ? std::make_unique<shells::SurfaceCanopy>(mesh, spec_.slope_deg) : nullptr) {}

MeshPass::Look MeshGround::look(glm::vec3 origin) const {
    MeshPass::Look look;
    look.place = origin;
    look.colour = glm::vec3(spec_.ground_colour);
    look.tier = 0;
    look.bare = glm::vec3(spec_.bare_colour);
    look.least_up = spec_.slope_deg >= 180
                        ? -2.0f
                        : static_cast<float>(std::cos(spec_.slope_deg * std::numbers::pi / 180));
    look.density = 1;
    return look;
}

void MeshGround::describe(shared::FrameConstants& frame, bool far_field) const {
    if (!has_set() || !far_field) {
        frame.handover_band = {kNoHandover_m, 1.001f * kNoHandover_m};
    }
    if (has_set()) {
        frame.patch_offset_m = glm::vec2(0);
        frame.anchor_tile = glm::ivec2(0);
        return;
    }
    frame.looks[0] = scene::appearance(spec_.species);
    frame.canopy_m = static_cast<float>(spec_.species.length_m.high);
    frame.blade_width_m = static_cast<float>(mean_blade_width_m());
}

} // namespace sward::render
