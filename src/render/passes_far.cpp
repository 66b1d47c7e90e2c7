// SPDX-License-Identifier: Apache-2.0
// What the passes of a picture do from its resolve on: the far field, and the picture's way out.
#include "render/frame.h"

namespace sward::render {

bool Frame::marches() const {
    return has_far() && s_.far == FarScheme::kMarch && s_.shells && !f_.march_textures.empty() &&
           f_.ground->has_far();
}

void Frame::resolve() {
    passes_.screen.resolve(v_.targets, 1.0f / static_cast<float>(at_.pictures), at_.number == 0);
}

void Frame::follow_light() {
    f_.follow_light(at_.shot.constants.light, at_.shot.constants.wind);
}

void Frame::march() {
    const shells::MarchPass::Inputs inputs = ground_->march_inputs();
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
