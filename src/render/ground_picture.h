// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/view_state.h"
#include "shells/march_pass.h"
#include "terrain/frustum.h"

namespace sward::render {

/// What the passes of a picture are given.
struct PictureContext {
    ViewState& view;
    FieldState& field;
    const FrameSettings& settings;
    DrawPasses& passes;
    int pictures = 1; ///< jittered ones that are averaged
    int number = 0;   ///< of the one in the making
    Shot shot{};

    /// Of a picture, in pixels: they stand on a grid; one alone is not moved.
    [[nodiscard]] glm::dvec2 jitter(int of) const;
    [[nodiscard]] terrain::Frustum frustum() const {
        return terrain::Frustum(shot.constants.clip_from_world);
    }
    /// The reference shows all there is.
    [[nodiscard]] blades::CullTests tests() const;
    /// Null where no blade that is drawn lives.
    [[nodiscard]] const blades::LivingBlades* living() const {
        return settings.physics && draws_blades(settings) ? field.living() : nullptr;
    }
    [[nodiscard]] const blades::PhysicsPass* living_pass() const {
        const blades::LivingBlades* const alive = living();
        return alive ? &alive->pass() : nullptr;
    }
};

/// The ground and its blades in one picture: what frame.cpp's list calls, in its order.
class GroundPicture {
public:
    explicit GroundPicture(PictureContext& context) : at_(context) {}
    virtual ~GroundPicture() = default;
    GroundPicture(const GroundPicture&) = delete;
    GroundPicture& operator=(const GroundPicture&) = delete;

    /// Before each of a frame's pictures.
    virtual void begin() = 0;

    /// It is drawn by blocks of a clipmap, which the passes down to sample_blocks() prepare.
    [[nodiscard]] virtual bool has_blocks() const = 0;
    virtual void update_clipmap() {}
    virtual void follow_shadow() {}
    virtual void select_blocks() {}
    [[nodiscard]] const std::vector<terrain::VisibleBlock>& blocks() const { return blocks_; }
    virtual void sample_blocks() {}

    [[nodiscard]] virtual const char* draw_name() const = 0; ///< the pass's
    virtual void draw() = 0;

    /// Blades are culled by the reference's samples: by the rounds below instead of the batches.
    [[nodiscard]] virtual bool sampled() const { return false; }
    virtual void select_blades() = 0;
    [[nodiscard]] virtual bool next_batch() = 0;
    virtual void cull_batch() = 0;
    virtual void draw_batch() = 0;

    [[nodiscard]] virtual bool begins_round() const { return false; }
    virtual void choose_blades() {} ///< for a round of pictures
    [[nodiscard]] virtual bool next_gathered() { return false; }
    virtual void gather_batch() {}
    virtual void sift_batch() {}
    virtual void draw_gathered() {}

    virtual void draw_canopy() = 0;
    [[nodiscard]] virtual shells::MarchPass::Inputs march_inputs() const = 0;

protected:
    PictureContext& at_;
    std::vector<terrain::VisibleBlock> blocks_;
};

} // namespace sward::render
