// SPDX-License-Identifier: Apache-2.0
#include "render/elevation_ground.h"

#include <span>

#include "render/elevation_picture.h"
#include "render/reload.h"

namespace sward::render {

ElevationGround::ElevationGround(const FieldState& field)
    : blade_records(gl::Buffer::of(std::span<const shared::BladeRecord>(field.world.grass.blades))),
      field_(field), blade_width_m_(mean_blade_width_m(field.world.grass)),
      land_shadow_(field.surface.elevation()) {}

std::unique_ptr<GroundPicture> ElevationGround::picture(PictureContext& context) {
    return std::make_unique<ElevationPicture>(context, *this);
}

void ElevationGround::describe(shared::FrameConstants& frame, glm::dvec2 anchor,
                               bool /*far_field*/) const {
    land_shadow_.describe(frame, anchor);
}

void ElevationGround::make_living(const blades::LivingBlades::Settings& settings) {
    simulation =
        std::make_unique<blades::Simulation>(field_.world.grass, field_.response, settings);
}

void ElevationGround::bind_under_blades(terrain::Clipmap& clipmap, glm::dvec2 eye) const {
    clipmap.update(eye);
    clipmap.bind();
}

CullCounts ElevationGround::cull_counts(bool sampled) const {
    return sampled ? sample_cull_->counts() : cull.counts();
}

blades::SampleCull& ElevationGround::sample_cull() {
    if (!sample_cull_) {
        sample_cull_ = std::make_unique<blades::SampleCull>();
    }
    return *sample_cull_;
}

void ElevationGround::reload(std::vector<std::string>& failures) {
    render::reload(&cull, failures);
    render::reload(sample_cull_.get(), failures);
    render::reload(simulation ? &simulation->pass() : nullptr, failures);
}

} // namespace sward::render
