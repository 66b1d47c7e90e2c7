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

} // namespace

Frame::Frame(ViewState& view, const Camera& camera, const FrameSettings& settings,
             const HostTextures& host)
    : v_(view), f_(*view.field), s_(settings), host_(host), lens_(lens_of(camera)),
      passes_(f_.passes(settings.aov)), at_{view, f_, settings, passes_,
                                            settings.tiers == Tiers::kReference
                                                ? settings.reference_grid * settings.reference_grid
                                                : 1},
      ground_(f_.ground->picture(at_)) {}

void Frame::begin_picture() {
    if (v_.reloads != f_.reloads) {
        v_.clipmap.refill();
        v_.reloads = f_.reloads;
    }
    at_.shot = f_.make_shot(v_.clipmap, lens_, s_, at_.jitter(at_.number));
    if (!at_.living()) {
        at_.shot.constants.living_band = glm::vec2(0);
        at_.shot.constants.page_blades = 0;
    }
    v_.frame_buffer.upload(&at_.shot.constants, sizeof(at_.shot.constants));
    v_.frame_buffer.bind_uniform(BIND_FRAME);
    f_.wind.bind();
    if (f_.tracks) {
        f_.tracks->bind();
    }
    ground_->begin();
}

void Frame::update_far_appearance() {
    f_.far_appearance.update(at_.shot.constants.light, at_.shot.constants.wind);
    f_.far_appearance.bind();
}

void Frame::select_far() {
    const shared::FrameConstants& constants = at_.shot.constants;
    shares_ = s_.far == FarScheme::kPublished ? shells::published_shares()
                                              : shells::fitted_shares(f_.world.grass);
    far_ = shells::select_far(f_.world.grass, ground_->blocks(), at_.shot.bands,
                              {constants.eye, constants.lod_eye, constants.patch_offset_m,
                               constants.far_alone != 0, s_.force_far_level, shares_,
                               mean_bend(constants)});
}

void Frame::begin_scene() {
    v_.targets.bind_scene();
    set_gl_state(lens_.mirrored);
}

void Frame::take_host_scene() {
    passes_.screen.take_scene(host_.scene_colour, host_.scene_depth, lens_.host_depth);
}

void Frame::draw_objects() {
    f_.objects.draw(passes_.meshes, f_.world.scene, f_.surface, at_.shot.anchor, f_.time_s);
}

void Frame::build_pyramid() {
    v_.depth_pyramid.build(v_.targets.scene_depth(), v_.targets.samples());
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
