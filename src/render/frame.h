// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blades/blade_tiles.h"
#include "render/view_state.h"
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
    void draw_picture();
    /// A pass: its timer, its debug group, what it does; where it is wanted.
    void run(const char* name, bool wanted, Step step);

    // What a picture has.
    [[nodiscard]] bool on_elevation() const { return !f_.on_mesh(); }
    [[nodiscard]] bool on_mesh() const { return f_.on_mesh(); }
    [[nodiscard]] bool has_blades() const { return draws_blades(s_); }
    [[nodiscard]] bool has_far() const {
        return s_.tiers == Tiers::kAll || s_.tiers == Tiers::kShells;
    }
    [[nodiscard]] bool sampled() const {
        return on_elevation() && samples_decide(s_, v_.targets.samples());
    }
    [[nodiscard]] bool marches() const;
    [[nodiscard]] bool rasterises() const {
        return on_elevation() && has_far() && s_.far != FarScheme::kMarch;
    }
    [[nodiscard]] const blades::LivingBlades* living() const {
        return s_.physics && has_blades() ? f_.living() : nullptr;
    }

    // Between passes.
    void begin_picture();
    /// Of a picture of the frame, in pixels: they stand on a grid; one alone is not moved.
    [[nodiscard]] glm::dvec2 jitter_of(int picture) const;
    void begin_scene();
    bool next_batch();
    bool next_gathered();
    [[nodiscard]] bool begins_round() const {
        return sampled() && has_blades() && (picture_ == 0 || picture_ >= round_end_);
    }

    // The passes, in order.
    void update_clipmap();
    void update_far_appearance();
    void select_blocks();
    void select_far();
    void sample_blocks();
    void take_host_scene();
    void draw_objects();
    void draw_surface();
    void draw_terrain();
    void build_pyramid();
    void select_blades();
    void cull_batch();
    void draw_batch();
    void choose_blades(); ///< of the reference, these four in the place of the three above; this
                          ///< one for a round of pictures
    void gather_batch();
    void sift_batch();
    void draw_gathered();
    void draw_surface_blades(); ///< opens the passes of culling and drawing in turn, as the two
                                ///< above are run
    void draw_shells();
    void draw_slices();
    void draw_sky();
    void resolve();
    void follow_shadow();
    void follow_light();
    void draw_canopy();
    void march();
    void tone_map();
    void hand_out();

    ViewState& v_;
    FieldState& f_;
    const FrameSettings& s_;
    const HostTextures& host_;
    Lens lens_;
    DrawPasses& passes_;
    int picture_ = 0, pictures_ = 1; ///< jittered ones that are averaged
    Shot shot_;
    std::vector<terrain::VisibleBlock> blocks_;
    bool fine_ = false; ///< ground finer than the clipmap
    shells::FarList far_;
    shared::FarShares shares_{};          ///< of the raster schemes
    int round_begin_ = 0, round_end_ = 0; ///< pictures that the choice of blades holds for
    std::size_t batch_ = 0;               ///< one more than the batch of blades in the making
};

} // namespace sward::render
