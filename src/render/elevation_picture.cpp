// SPDX-License-Identifier: Apache-2.0
// What the passes of a picture do on elevation, but for the reference's blades
// (elevation_reference.cpp).
#include "render/elevation_picture.h"

#include "render/pass_names.h"
#include "shared/bindings.h"

namespace sward::render {

const char* ElevationPicture::draw_name() const {
    return pass_names::kTerrain;
}

void ElevationPicture::update_clipmap() {
    const shared::FrameConstants& constants = at_.shot.constants;
    at_.view.clipmap.update(
        {at_.shot.anchor.x + constants.eye.x, at_.shot.anchor.z + constants.eye.z});
    at_.view.clipmap.bind();
}

void ElevationPicture::follow_shadow() {
    at_.field.follow_shadow();
}

void ElevationPicture::select_blocks() {
    const shared::FrameConstants& constants = at_.shot.constants;
    terrain::Detail detail = at_.shot.detail;
    blocks_ = terrain::visible_blocks(
        at_.view.clipmap, at_.field.surface, at_.frustum(), at_.shot.anchor,
        {constants.eye, at_.field.world.grass.canopy_m * constants.land_highest}, detail);
    fine_ = detail.on();
    if (fine_) {
        at_.view.clipmap.bind_posts({at_.shot.anchor.x, at_.shot.anchor.z}, detail);
    }
}

void ElevationPicture::sample_blocks() {
    at_.view.block_samples.execute(blocks_, fine_);
}

void ElevationPicture::draw() {
    at_.passes.terrain.execute(static_cast<int>(blocks_.size()), at_.field.block_mesh, fine_);
}

bool ElevationPicture::sampled() const {
    return samples_decide(at_.settings, at_.view.targets.samples());
}

blades::TileList ElevationPicture::tiles_in(const terrain::Frustum& frustum) const {
    const shared::FrameConstants& constants = at_.shot.constants;
    return blades::select_tiles(
        at_.field.world.grass, at_.field.surface, frustum,
        {at_.shot.anchor, constants.lod_eye, constants.handover_band, constants.handover_mode,
         at_.living() ? &ground_.simulation->pages() : nullptr, constants.land_highest});
}

void ElevationPicture::select_blades() {
    const blades::TileList tiles = tiles_in(at_.frustum());
    ground_.cull.upload(tiles, at_.view.blades_considered > 0);
    at_.view.blades_considered += tiles.considered;
}

bool ElevationPicture::next_batch() {
    return !sampled() && batch_++ < ground_.cull.batches();
}

void ElevationPicture::cull_batch() {
    ground_.blade_records.bind_storage(BIND_BLADES);
    ground_.cull.execute(batch_ - 1, at_.tests());
}

void ElevationPicture::draw_batch() {
    at_.passes.blades.execute(ground_.cull, at_.living_pass());
}

void ElevationPicture::draw_canopy() {
    at_.view.canopy.require(at_.settings.width, at_.settings.height, at_.view.targets.samples());
    at_.passes.march.draw_canopy(at_.view.canopy, static_cast<int>(blocks_.size()),
                                 at_.field.block_mesh);
}

shells::MarchPass::Inputs ElevationPicture::march_inputs() const {
    const glm::dvec3 eye = at_.shot.anchor + glm::dvec3(at_.shot.constants.eye);
    return {at_.field.march_textures,
            at_.view.canopy,
            nullptr,
            {},
            at_.view.targets.samples(),
            static_cast<float>(eye.y - at_.field.surface.height(eye.x, eye.z)),
            fine_,
            at_.settings.count_steps};
}

} // namespace sward::render
