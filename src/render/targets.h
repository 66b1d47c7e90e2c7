// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace sward::render {

/// Where a frame is drawn: multisampled scene targets, their resolve, and the 8-bit picture.
class Targets {
public:
    /// Makes (or keeps) targets of this shape. Throws Error(kOverLimit) over the GPU's size or
    /// sample limit.
    void require(int width, int height, int samples, bool aov);

    void bind_scene() const { scene_.bind(width_, height_); }
    void bind_resolved() const { resolved_.bind(width_, height_); }
    void bind_display() const { display_.bind(width_, height_); }
    /// Binds the scene's textures for the resolve, the resolved colour for the tone map.
    void bind_scene_textures() const;
    void bind_resolved_color() const;
    /// The resolved colour and data.
    void bind_resolved_textures() const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    /// Samples a pixel has: the GPU may give more than were asked for.
    [[nodiscard]] int samples() const { return real_samples_; }
    [[nodiscard]] bool aov() const { return aov_; }
    [[nodiscard]] const gl::Texture& scene_depth() const { return scene_depth_; }
    [[nodiscard]] const gl::Framebuffer& display() const { return display_; }
    [[nodiscard]] const gl::Texture& picture() const { return picture_; }
    /// rgb radiance and coverage, averaged over samples and jittered frames.
    [[nodiscard]] const gl::Texture& color() const { return color_; }
    /// Of each pixel's first sample: depth along the view axis (m), tier, rank; tangent; normal.
    [[nodiscard]] const gl::Texture& data() const { return data_; }
    [[nodiscard]] const gl::Texture& tangent() const { return tangent_; }
    [[nodiscard]] const gl::Texture& normal() const { return normal_; }

private:
    int width_ = 0, height_ = 0, samples_ = 0, real_samples_ = 0;
    bool aov_ = false;
    gl::Texture scene_color_, scene_depth_, scene_data_, scene_tangent_, scene_normal_;
    gl::Texture color_, data_, tangent_, normal_, picture_;
    gl::Texture kinds_; ///< depth of the resolved targets: the far field's choice of kinds
    gl::Framebuffer scene_, resolved_, display_;
};

} // namespace sward::render
