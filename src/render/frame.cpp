// SPDX-License-Identifier: Apache-2.0
// A picture, top to bottom: one line a pass. Before it, once for all views: FieldState::simulate
// (wind, pages, physics). After it: the overlay, which is the host's.
#include "render/frame.h"

#include "render/pass_names.h"

namespace sward::render {

using namespace pass_names;

void Frame::run(const char* name, bool wanted, Step step) {
    if (wanted) {
        const gl::PassScope pass(v_.timers, name);
        (this->*step)();
    }
}

void Frame::run(const char* name, bool wanted, GroundStep step) {
    if (wanted) {
        const gl::PassScope pass(v_.timers, name);
        (ground_.get()->*step)();
    }
}

void Frame::draw() {
    for (at_.number = 0; at_.number < at_.pictures; ++at_.number) {
        draw_picture();
    }
    run(kToneMap, host_.display, &Frame::tone_map);
    run(kHandOut, host_.gives(), &Frame::hand_out);
}

void Frame::draw_picture() {
    begin_picture(); // uploads the constants that every pass below reads
    run(kClipmap, has_blocks(), &GroundPicture::update_clipmap);
    run(kLandShadow, has_blocks(), &GroundPicture::follow_shadow);
    run(kFarAppearance, rasterises(), &Frame::update_far_appearance);
    run(kSelectBlocks, has_blocks(), &GroundPicture::select_blocks);
    run(kSelectFar, rasterises(), &Frame::select_far);
    run(kBlockSamples, has_blocks(), &GroundPicture::sample_blocks);
    begin_scene(); // targets, GL state, clear colour and depth
    run(kHostScene, host_.takes_scene(), &Frame::take_host_scene);
    run(kObjects, f_.objects.count() > 0, &Frame::draw_objects);
    run(ground_->draw_name(), s_.terrain, &GroundPicture::draw); // kTerrain, kSurface
    run(kDepthPyramid, has_blades() && s_.cull.occlusion && !sampled(), &Frame::build_pyramid);
    run(kSelectBlades, has_blades() && !sampled(), &GroundPicture::select_blades);
    while (has_blades() && ground_->next_batch()) {
        run(kCullBlades, true, &GroundPicture::cull_batch);
        run(kDrawBlades, true, &GroundPicture::draw_batch);
    }
    run(kChooseBlades, has_blades() && ground_->begins_round(), &GroundPicture::choose_blades);
    while (has_blades() && ground_->next_gathered()) {
        run(kGatherBlades, true, &GroundPicture::gather_batch);
        run(kSiftBlades, s_.cull.occlusion, &GroundPicture::sift_batch);
        run(kDrawBlades, true, &GroundPicture::draw_gathered);
    }
    run(kShells, rasterises() && s_.shells, &Frame::draw_shells);
    run(kSlices, rasterises() && s_.slices, &Frame::draw_slices);
    run(kSky, s_.sky, &Frame::draw_sky);
    run(kResolve, true, &Frame::resolve);
    run(kFarLight, marches(), &Frame::follow_light);
    run(kCanopy, marches(), &GroundPicture::draw_canopy);
    run(kFarField, marches(), &Frame::march);
}

} // namespace sward::render
