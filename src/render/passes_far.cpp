// SPDX-License-Identifier: Apache-2.0
// What the passes of a picture do from its resolve on: the far field, and the picture's way out.
#include "render/frame.h"

namespace sward::render {

namespace {

constexpr float kApart = 0.004f; // canopies: nearer along a ray, two surfaces of a mesh are one

} // namespace

bool Frame::marches() const {
    const bool has_canopy = on_elevation() || f_.mesh_ground->has_set();
    return has_far() && s_.far == FarScheme::kMarch && s_.shells && !f_.march_textures.empty() &&
           has_canopy;
}

void Frame::resolve() {
    passes_.screen.resolve(v_.targets, 1.0f / static_cast<float>(pictures_), picture_ == 0);
}

void Frame::follow_light() {
    f_.follow_light(shot_.constants.light, shot_.constants.wind);
}

void Frame::draw_canopy() {
    if (on_mesh()) {
        v_.surface_canopy.require(s_.width, s_.height);
        f_.march_textures.bind(); // the canopy's height knows how far its blades lean
        passes_.march.draw_surface(v_.surface_canopy, f_.mesh_ground->canopy(),
                                   glm::vec3(-shot_.anchor), kApart * f_.world.grass.canopy_m);
    } else {
        v_.canopy.require(s_.width, s_.height, v_.targets.samples());
        passes_.march.draw_canopy(v_.canopy, static_cast<int>(blocks_.size()), f_.block_mesh);
    }
}

void Frame::march() {
    const int samples = v_.targets.samples();
    const glm::dvec3 eye = shot_.anchor + glm::dvec3(shot_.constants.eye);
    const shells::MarchPass::Inputs inputs =
        on_mesh()
            ? shells::MarchPass::Inputs{f_.march_textures,
                                        v_.surface_canopy.first,
                                        &v_.surface_canopy,
                                        glm::vec3(-shot_.anchor),
                                        samples,
                                        0}
            : shells::MarchPass::Inputs{f_.march_textures,
                                        v_.canopy,
                                        nullptr,
                                        {},
                                        samples,
                                        static_cast<float>(eye.y - f_.surface.height(eye.x, eye.z)),
                                        fine_,
                                        s_.count_steps};
    v_.targets.bind_resolved();
    passes_.march.choose(inputs);
    v_.targets.bind_scene_textures();
    passes_.march.execute(inputs);
}

void Frame::tone_map() {
    passes_.screen.tone_map(v_.targets, s_.exposure);
}

void Frame::hand_out() {
    passes_.screen.hand_out(v_.targets, host_.colour, host_.depth, lens_.host_depth);
}

} // namespace sward::render
