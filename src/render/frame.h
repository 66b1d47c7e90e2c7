// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/ground_picture.h"
#include "shells/far_instances.h"

namespace sward::render {

/// One picture of a view in the making: the list of its passes (frame.cpp) and what each of them
/// does (passes.cpp).
class Frame {
public:
    Frame(ViewState& view, const Camera& camera, const FrameSettings& settings,
          const HostTextures& host);
    void draw();

private:
    using Step = void (Frame::*)();
    using GroundStep = void (GroundPicture::*)();
    void draw_picture();
    /// A pass: its timer, its debug group, what it does; where it is wanted.
    void run(const char* name, bool wanted, Step step);
    void run(const char* name, bool wanted, GroundStep step);

    // What a picture has.
    [[nodiscard]] bool has_blades() const { return draws_blades(s_); }
    [[nodiscard]] bool has_blocks() const { return ground_->has_blocks(); }
    [[nodiscard]] bool has_far() const {
        return s_.tiers == Tiers::kAll || s_.tiers == Tiers::kShells;
    }
    [[nodiscard]] bool sampled() const { return ground_->sampled(); }
    [[nodiscard]] bool marches() const;
    [[nodiscard]] bool rasterises() const {
        return has_blocks() && has_far() && s_.far != FarScheme::kMarch;
    }

    // Between passes.
    void begin_picture();
    void begin_scene();

    // The passes, in order; the ground's are GroundPicture's.
    void update_far_appearance();
    void select_far();
    void take_host_scene();
    void draw_objects();
    void build_pyramid();
    void draw_shells();
    void draw_slices();
    void draw_sky();
    void resolve();
    void follow_light();
    void march();
    void tone_map();
    void hand_out();

    ViewState& v_;
    FieldState& f_;
    const FrameSettings& s_;
    const HostTextures& host_;
    Lens lens_;
    DrawPasses& passes_;
    PictureContext at_;
    std::unique_ptr<GroundPicture> ground_;
    shells::FarList far_;
    shared::FarShares shares_{}; ///< of the raster schemes
};

} // namespace sward::render
