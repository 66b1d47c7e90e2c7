// SPDX-License-Identifier: Apache-2.0
// What the passes of a picture do up to the sky; passes_far.cpp has the rest.
#include <epoxy/gl.h>

#include "render/frame.h"
#include "render/pass_names.h"
#include "shared/bend.h"
#include "shared/bindings.h"
#include "shells/far_shares.h"

namespace sward::render {

namespace {

/// Where the mean wind turns an upright blade, at kLeanHeight: x, z.
glm::vec2 mean_bend(const shared::FrameConstants& frame) {
    const float canopy = frame.canopy_m;
    const glm::vec3 turn = shared::bend_turn(shared::kLeanHeight * canopy, canopy, frame.wind.mean,
                                             frame.wind.response);
    return {turn.x, turn.z};
}

void set_gl_state(bool mirrored) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glFrontFace(mirrored ? GL_CW : GL_CCW);
    glDisablei(GL_BLEND, 0);
    glDisablei(GL_SCISSOR_TEST, 0);
    glEnable(GL_MULTISAMPLE);
    constexpr float kClear[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, kClear);
    glClearBufferfv(GL_DEPTH, 0, kClear);
}

/// The reference shows all there is.
blades::CullTests tests_of(const FrameSettings& settings) {
    return settings.tiers == Tiers::kReference ? blades::CullTests{true, false, false, false}
                                               : settings.cull;
}

} // namespace

Frame::Frame(ViewState& view, const Camera& camera, const FrameSettings& settings,
             const HostTextures& host)
    : v_(view), f_(*view.field), s_(settings), host_(host), lens_(lens_of(camera)),
      passes_(f_.passes(settings.aov)),
      pictures_(settings.tiers == Tiers::kReference
                    ? settings.reference_grid * settings.reference_grid
                    : 1) {}

void Frame::begin_picture() {
    if (v_.reloads != f_.reloads) {
        v_.clipmap.refill();
        v_.reloads = f_.reloads;
    }
    shot_ = f_.make_shot(v_.clipmap, lens_, s_, jitter_of(picture_));
    if (!living()) {
        shot_.constants.living_band = glm::vec2(0);
        shot_.constants.page_blades = 0;
    }
    v_.frame_buffer.upload(&shot_.constants, sizeof(shot_.constants));
    v_.frame_buffer.bind_uniform(BIND_FRAME);
    f_.wind.bind();
    if (f_.tracks) {
        f_.tracks->bind();
    }
    batch_ = 0;
}

void Frame::update_clipmap() {
    v_.clipmap.update(
        {shot_.anchor.x + shot_.constants.eye.x, shot_.anchor.z + shot_.constants.eye.z});
    v_.clipmap.bind();
}

void Frame::follow_shadow() {
    f_.follow_shadow();
}

void Frame::update_far_appearance() {
    f_.far_appearance.update(shot_.constants.light, shot_.constants.wind);
    f_.far_appearance.bind();
}

void Frame::select_blocks() {
    terrain::Detail detail = shot_.detail;
    blocks_ = terrain::visible_blocks(
        v_.clipmap, f_.surface, terrain::Frustum(shot_.constants.clip_from_world), shot_.anchor,
        {shot_.constants.eye, f_.world.grass.canopy_m * shot_.constants.land_highest}, detail);
    fine_ = detail.on();
    if (fine_) {
        v_.clipmap.bind_posts({shot_.anchor.x, shot_.anchor.z}, detail);
    }
}

void Frame::select_far() {
    const shared::FrameConstants& constants = shot_.constants;
    shares_ = s_.far == FarScheme::kPublished ? shells::published_shares()
                                              : shells::fitted_shares(f_.world.grass);
    far_ = shells::select_far(f_.world.grass, blocks_, shot_.bands,
                              {constants.eye, constants.lod_eye, constants.patch_offset_m,
                               constants.far_alone != 0, s_.force_far_level, shares_,
                               mean_bend(constants)});
}

void Frame::sample_blocks() {
    v_.block_samples.execute(blocks_, fine_);
}

void Frame::begin_scene() {
    v_.targets.bind_scene();
    set_gl_state(lens_.mirrored);
}

void Frame::take_host_scene() {
    passes_.screen.take_scene(host_.scene_colour, host_.scene_depth, lens_.host_depth);
}

void Frame::draw_objects() {
    f_.objects.draw(passes_.meshes, f_.world.scene, f_.surface, shot_.anchor, f_.time_s);
}

void Frame::draw_surface() {
    passes_.meshes.execute(f_.mesh_ground->mesh(), f_.mesh_ground->look(glm::vec3(-shot_.anchor)));
}

void Frame::draw_terrain() {
    passes_.terrain.execute(static_cast<int>(blocks_.size()), f_.block_mesh, fine_);
}

void Frame::build_pyramid() {
    v_.depth_pyramid.build(v_.targets.scene_depth(), v_.targets.samples());
}

void Frame::select_blades() {
    const auto tiles = blades::select_tiles(
        f_.world.grass, f_.surface, terrain::Frustum(shot_.constants.clip_from_world),
        {shot_.anchor, shot_.constants.lod_eye, shot_.constants.handover_band,
         shot_.constants.handover_mode, living() ? &f_.simulation->pages() : nullptr,
         shot_.constants.land_highest});
    f_.cull.upload(tiles, v_.blades_considered > 0);
    v_.blades_considered += tiles.considered;
}

bool Frame::next_batch() {
    return on_elevation() && has_blades() && !sampled() && batch_++ < f_.cull.batches();
}

void Frame::cull_batch() {
    f_.blade_records.bind_storage(BIND_BLADES);
    f_.cull.execute(batch_ - 1, tests_of(s_));
}

void Frame::draw_batch() {
    passes_.blades.execute(f_.cull, living() ? &living()->pass() : nullptr);
}

void Frame::draw_surface_blades() {
    if (!on_mesh() || !has_blades()) {
        return;
    }
    blades::SurfacePass& grass = f_.mesh_ground->grass();
    grass.limit(shot_.constants.lod_eye, shot_.constants.handover_band.y);
    grass.execute(terrain::Frustum(shot_.constants.clip_from_world), glm::vec3(-shot_.anchor),
                  passes_.surface(s_.aov), tests_of(s_), v_.blades_considered > 0,
                  living() ? f_.surface_simulation.get() : nullptr,
                  [this](const char* name, auto&& step) {
                      const gl::PassScope pass(v_.timers, name);
                      step();
                  });
    v_.blades_considered = grass.considered();
}

void Frame::draw_shells() {
    passes_.shells.execute({f_.far_textures, far_.shells, f_.block_mesh, shares_});
}

void Frame::draw_slices() {
    passes_.slices.execute({f_.far_textures, far_.slices, f_.block_mesh, shares_});
}

void Frame::draw_sky() {
    passes_.screen.sky();
}

} // namespace sward::render
