// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "gl/texture.h"
#include "shared/frame.h"
#include "terrain/sun_sweep.h"

namespace sward::terrain {

/// The shadow of the land on the GPU, for every tier (shaders/lib/land_shadow.glsl). Two textures
/// of SunSweep's size, 4 bytes a post each.
class LandShadow {
public:
    static constexpr double kStep_deg = 0.1; ///< the sun's way from one shadow to the next
    static constexpr int kPostsAFrame =
        50000; ///< looked at a frame, some 3 ms of one core; uploaded: four times as many

    explicit LandShadow(const scene::Heightfield& elevation);

    /// Brings the shadow to a sun (unit direction, y up). `at_once`: whole, for exactly this sun;
    /// else by a part a frame, the shadow before standing until the next is through, and none for a
    /// sun that goes on and has moved by less than kStep_deg. The first is always whole.
    void follow(const glm::dvec3& to_sun, bool at_once);
    void bind() const;
    /// Fills shadow_offset, shadow_per_m and has_shadow for an anchor (world metres).
    void describe(shared::FrameConstants& frame, glm::dvec2 anchor) const;

private:
    void upload(int rows);
    const scene::Heightfield& elevation_;
    SunSweep sweep_;
    gl::Texture shown_, next_;
    glm::dvec3 shown_sun_{0}, next_sun_{0}, asked_sun_{0};
    bool sweeping_ = false;
    int uploaded_ = 0; ///< rows of the next texture
};

} // namespace sward::terrain
