// SPDX-License-Identifier: Apache-2.0
// The reference's blades: of all that stand, those that a sample falls on and that nothing drawn
// before hides from it.
#include <algorithm>

#include <epoxy/gl.h>

#include "render/frame.h"
#include "shared/bindings.h"

namespace sward::render {

namespace {

/// Of a pixel in the bound framebuffer.
std::vector<glm::vec2> sample_places(int samples) {
    std::vector<glm::vec2> places(static_cast<std::size_t>(samples), glm::vec2(0.5f));
    for (int i = 0; samples > 1 && i < samples; ++i) {
        glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i),
                           &places[static_cast<std::size_t>(i)].x);
    }
    return places;
}

/// What any picture of a round sees: its first one's view and a pixel around it.
terrain::Frustum frustum_of_round(const Shot& shot) {
    const glm::vec2 picture(shot.constants.picture_px);
    const glm::vec4 shrunk(1 / (1 + 2.0f / picture.x), 1 / (1 + 2.0f / picture.y), 1, 1);
    return terrain::Frustum(glm::mat4(glm::vec4(shrunk.x, 0, 0, 0), glm::vec4(0, shrunk.y, 0, 0),
                                      glm::vec4(0, 0, 1, 0), glm::vec4(0, 0, 0, 1)) *
                            shot.constants.clip_from_world);
}

} // namespace

glm::dvec2 Frame::jitter_of(int picture) const {
    const int grid = pictures_ > 1 ? s_.reference_grid : 1;
    return (glm::dvec2(picture % grid, picture / grid) + 0.5) / static_cast<double>(grid) - 0.5;
}

void Frame::choose_blades() {
    if (!f_.sample_cull) {
        f_.sample_cull = std::make_unique<blades::SampleCull>();
    }
    const auto tiles = blades::select_tiles(
        f_.world.grass, f_.surface, frustum_of_round(shot_),
        {shot_.anchor, shot_.constants.lod_eye, shot_.constants.handover_band,
         shot_.constants.handover_mode, living() ? &f_.simulation->pages() : nullptr,
         shot_.constants.land_highest});
    const int most =
        tiles.items.size() > blades::SampleCull::kMostKept ? 1 : blades::SampleCull::kRound;
    round_begin_ = picture_;
    round_end_ = std::min(picture_ + most, pictures_);
    std::vector<glm::vec2> jitters;
    for (int picture = round_begin_; picture < round_end_; ++picture) {
        jitters.emplace_back(jitter_of(picture) - jitter_of(round_begin_));
    }
    f_.blade_records.bind_storage(BIND_BLADES);
    f_.sample_cull->upload(tiles, sample_places(v_.targets.samples()), jitters,
                           v_.blades_considered > 0);
    v_.blades_considered += tiles.considered * jitters.size();
    f_.sample_cull->choose(living() ? &living()->pass() : nullptr);
}

bool Frame::next_gathered() {
    return sampled() && has_blades() && batch_++ < f_.sample_cull->batches();
}

void Frame::gather_batch() {
    f_.blade_records.bind_storage(BIND_BLADES);
    f_.sample_cull->gather(batch_ - 1, picture_ - round_begin_,
                           living() ? &living()->pass() : nullptr);
}

void Frame::sift_batch() {
    f_.blade_records.bind_storage(BIND_BLADES);
    f_.sample_cull->sift(v_.targets.scene_depth(), living() ? &living()->pass() : nullptr);
}

void Frame::draw_gathered() {
    passes_.blades.execute(*f_.sample_cull, living() ? &living()->pass() : nullptr);
}

} // namespace sward::render
