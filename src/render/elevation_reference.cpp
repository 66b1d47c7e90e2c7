// SPDX-License-Identifier: Apache-2.0
// The reference's blades: of all that stand, those that a sample falls on and that nothing drawn
// before hides from it.
#include <algorithm>

#include <epoxy/gl.h>

#include "render/elevation_picture.h"
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

void ElevationPicture::choose_blades() {
    blades::SampleCull& sample_cull = ground_.sample_cull();
    const blades::TileList tiles = tiles_in(frustum_of_round(at_.shot));
    const int most =
        tiles.items.size() > blades::SampleCull::kMostKept ? 1 : blades::SampleCull::kRound;
    round_begin_ = at_.number;
    round_end_ = std::min(at_.number + most, at_.pictures);
    std::vector<glm::vec2> jitters;
    for (int picture = round_begin_; picture < round_end_; ++picture) {
        jitters.emplace_back(at_.jitter(picture) - at_.jitter(round_begin_));
    }
    ground_.blade_records.bind_storage(BIND_BLADES);
    sample_cull.upload(tiles, sample_places(at_.view.targets.samples()), jitters,
                       at_.view.blades_considered > 0);
    at_.view.blades_considered += tiles.considered * jitters.size();
    sample_cull.choose(at_.living_pass());
}

bool ElevationPicture::next_gathered() {
    return sampled() && batch_++ < ground_.sample_cull().batches();
}

void ElevationPicture::gather_batch() {
    ground_.blade_records.bind_storage(BIND_BLADES);
    ground_.sample_cull().gather(batch_ - 1, at_.number - round_begin_, at_.living_pass());
}

void ElevationPicture::sift_batch() {
    ground_.blade_records.bind_storage(BIND_BLADES);
    ground_.sample_cull().sift(at_.view.targets.scene_depth(), at_.living_pass());
}

void ElevationPicture::draw_gathered() {
    at_.passes.blades.execute(ground_.sample_cull(), at_.living_pass());
}

} // namespace sward::render
