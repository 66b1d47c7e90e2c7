// SPDX-License-Identifier: Apache-2.0
#include "terrain/land_shadow.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <epoxy/gl.h>

#include "base/angles.h"
#include "shared/bindings.h"

namespace sward::terrain {
namespace {

gl::Texture shadow_texture(const SunSweep& sweep) {
    gl::Texture texture(GL_RG16F, {sweep.width(), sweep.height()});
    texture.set_filter(GL_LINEAR, GL_LINEAR);
    texture.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    return texture;
}

} // namespace

LandShadow::LandShadow(const scene::Heightfield& elevation)
    : elevation_(elevation), sweep_(elevation), shown_(shadow_texture(sweep_)),
      next_(shadow_texture(sweep_)) {}

void LandShadow::follow(const glm::dvec3& to_sun, bool at_once) {
    const bool first = shown_sun_ == glm::dvec3(0);
    const bool whole = at_once || first;
    const bool stands = to_sun == asked_sun_;
    asked_sun_ = to_sun;
    const bool far_off = glm::dot(to_sun, shown_sun_) < std::cos(kStep_deg * base::kDegree);
    if (to_sun != shown_sun_ && (whole || (!sweeping_ && (far_off || stands)))) {
        sweep_.begin(to_sun);
        next_sun_ = to_sun;
        sweeping_ = true;
        uploaded_ = 0;
    }
    if (!sweeping_) {
        return;
    }
    const int rows = whole ? std::max(sweep_.width(), sweep_.height())
                           : std::max(kPostsAFrame / sweep_.row_posts(), 1);
    if (!sweep_.advance(rows)) {
        return;
    }
    upload(whole ? sweep_.height() : std::max(4 * kPostsAFrame / sweep_.width(), 1));
    if (uploaded_ == sweep_.height()) {
        std::swap(shown_, next_);
        shown_sun_ = next_sun_;
        sweeping_ = false;
    }
}

void LandShadow::upload(int rows) {
    const int count = std::min(rows, sweep_.height() - uploaded_);
    next_.upload_rows(uploaded_, count, GL_RG, GL_HALF_FLOAT,
                      sweep_.seen_from().data() +
                          static_cast<std::ptrdiff_t>(uploaded_) * sweep_.width());
    uploaded_ += count;
}

void LandShadow::bind() const {
    shown_.bind(TEX_LAND_SHADOW);
}

void LandShadow::describe(shared::FrameConstants& frame, glm::dvec2 anchor) const {
    const glm::dvec2 size(sweep_.width(), sweep_.height()),
        texel = elevation_.spacing_m * static_cast<double>(sweep_.step());
    const glm::dvec2 first = -0.5 * elevation_.extent_m(); // of the posts
    frame.shadow_offset = glm::vec2(((anchor - first) / texel + 0.5) / size);
    frame.shadow_per_m = glm::vec2(1.0 / (texel * size));
    frame.has_shadow = 1;
}

} // namespace sward::terrain
