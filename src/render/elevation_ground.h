// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blades/cull_pass.h"
#include "blades/sample_cull.h"
#include "gl/buffer.h"
#include "render/field_state.h"
#include "render/ground.h"
#include "terrain/land_shadow.h"

namespace sward::render {

/// A set's grass on elevation: a clipmap drawn by blocks, tiles of blades around the eye.
class ElevationGround final : public Ground {
public:
    /// The field outlives it.
    explicit ElevationGround(const FieldState& field);

    [[nodiscard]] std::unique_ptr<GroundPicture> picture(PictureContext& context) override;
    void describe(shared::FrameConstants& frame, glm::dvec2 anchor, bool far_field) const override;
    void follow_sun(glm::dvec3 to_sun, bool at_once) override {
        land_shadow_.follow(to_sun, at_once);
    }
    void bind_shadow() const override { land_shadow_.bind(); }
    [[nodiscard]] bool has_far() const override { return true; }
    [[nodiscard]] bool on_charts() const override { return false; }
    [[nodiscard]] bool far_alone() const override { return !has_blades(); }
    [[nodiscard]] bool placed_for_good() const override { return false; }
    [[nodiscard]] double blade_width_m() const override { return blade_width_m_; }
    [[nodiscard]] bool has_blades() const override { return !field_.world.grass.blades.empty(); }
    [[nodiscard]] blades::LivingBlades* living() override { return simulation.get(); }
    void make_living(const blades::LivingBlades::Settings& settings) override;
    void bind_under_blades(terrain::Clipmap& clipmap, glm::dvec2 eye) const override;
    [[nodiscard]] CullCounts cull_counts(bool sampled) const override;
    void reload(std::vector<std::string>& failures) override;

    /// Made for the first picture that wants it.
    [[nodiscard]] blades::SampleCull& sample_cull();

    // What a picture of it draws with.
    gl::Buffer blade_records;
    blades::CullPass cull;
    std::unique_ptr<blades::Simulation> simulation; ///< made for the first frame that wants it

private:
    const FieldState& field_;
    double blade_width_m_;
    terrain::LandShadow land_shadow_;
    std::unique_ptr<blades::SampleCull> sample_cull_; ///< of the reference
};

} // namespace sward::render
