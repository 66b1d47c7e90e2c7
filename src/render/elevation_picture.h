// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blades/blade_tiles.h"
#include "render/elevation_ground.h"
#include "render/ground_picture.h"

namespace sward::render {

class ElevationPicture final : public GroundPicture {
public:
    ElevationPicture(PictureContext& context, ElevationGround& ground)
        : GroundPicture(context), ground_(ground) {}

    void begin() override { batch_ = 0; }
    [[nodiscard]] bool has_blocks() const override { return true; }
    void update_clipmap() override;
    void follow_shadow() override;
    void select_blocks() override;
    void sample_blocks() override;
    [[nodiscard]] const char* draw_name() const override;
    void draw() override;

    [[nodiscard]] bool sampled() const override;
    void select_blades() override;
    [[nodiscard]] bool next_batch() override;
    void cull_batch() override;
    void draw_batch() override;

    [[nodiscard]] bool begins_round() const override {
        return sampled() && (at_.number == 0 || at_.number >= round_end_);
    }
    void choose_blades() override;
    [[nodiscard]] bool next_gathered() override;
    void gather_batch() override;
    void sift_batch() override;
    void draw_gathered() override;

    void draw_canopy() override;
    [[nodiscard]] shells::MarchPass::Inputs march_inputs() const override;

private:
    [[nodiscard]] blades::TileList tiles_in(const terrain::Frustum& frustum) const;

    ElevationGround& ground_;
    bool fine_ = false;                   ///< ground finer than the clipmap
    int round_begin_ = 0, round_end_ = 0; ///< pictures that the choice of blades holds for
    std::size_t batch_ = 0;               ///< one more than the batch of blades in the making
};

} // namespace sward::render
