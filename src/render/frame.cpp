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

void Frame::draw() {
    for (picture_ = 0; picture_ < pictures_; ++picture_) {
        draw_picture();
    }
    run(kToneMap, host_.display, &Frame::tone_map);
    run(kHandOut, host_.gives(), &Frame::hand_out);
}

void Frame::draw_picture() {
    begin_picture(); // uploads the constants that every pass below reads
    run(kClipmap, on_elevation(), &Frame::update_clipmap);
    run(kLandShadow, on_elevation(), &Frame::follow_shadow);
    run(kFarAppearance, rasterises(), &Frame::update_far_appearance);
    run(kSelectBlocks, on_elevation(), &Frame::select_blocks);
    run(kSelectFar, rasterises(), &Frame::select_far);
    run(kBlockSamples, on_elevation(), &Frame::sample_blocks);
    begin_scene(); // targets, GL state, clear colour and depth
    run(kHostScene, host_.takes_scene(), &Frame::take_host_scene);
    run(kObjects, f_.objects.count() > 0, &Frame::draw_objects);
    run(kSurface, on_mesh() && s_.terrain, &Frame::draw_surface);
    run(kTerrain, on_elevation() && s_.terrain, &Frame::draw_terrain);
    run(kDepthPyramid, has_blades() && s_.cull.occlusion && !sampled(), &Frame::build_pyramid);
    run(kSelectBlades, on_elevation() && has_blades() && !sampled(), &Frame::select_blades);
    while (next_batch()) {
        run(kCullBlades, true, &Frame::cull_batch);
        run(kDrawBlades, true, &Frame::draw_batch);
    }
    run(kChooseBlades, begins_round(), &Frame::choose_blades);
    while (next_gathered()) {
        run(kGatherBlades, true, &Frame::gather_batch);
        run(kSiftBlades, s_.cull.occlusion, &Frame::sift_batch);
        run(kDrawBlades, true, &Frame::draw_gathered);
    }
    draw_surface_blades(); // kCullBlades and kDrawBlades in turn, of a mesh
    run(kShells, rasterises() && s_.shells, &Frame::draw_shells);
    run(kSlices, rasterises() && s_.slices, &Frame::draw_slices);
    run(kSky, s_.sky, &Frame::draw_sky);
    run(kResolve, true, &Frame::resolve);
    run(kFarLight, marches(), &Frame::follow_light);
    run(kCanopy, marches(), &Frame::draw_canopy);
    run(kFarField, marches(), &Frame::march);
}

} // namespace sward::render
