// SPDX-License-Identifier: Apache-2.0
#include "render/targets.h"

#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "shared/bindings.h"

namespace sward::render {

namespace {

void check_limits(int width, int height, int samples) {
    GLint side = 0, most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    if (width < 1 || height < 1 || width > side || height > side) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("size: found {}x{}, this GPU draws 1x1 to {}x{}", width,
                                      height, side, side));
    }
    if (samples < 1 || samples > most) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("samples: found {}, this GPU takes 1 to {}", samples, most));
    }
}

} // namespace

void Targets::require(int width, int height, int samples, bool aov) {
    if (width == width_ && height == height_ && samples == samples_ && aov == aov_) {
        return;
    }
    check_limits(width, height, samples);
    *this = Targets(); // the old ones first: two sets at once may not fit
    const gl::TextureShape multisampled{width, height, 0, 1, samples};
    const gl::TextureShape plain{width, height};
    scene_color_ = gl::Texture(GL_RGBA16F, multisampled);
    scene_depth_ = gl::Texture(GL_DEPTH_COMPONENT32F, multisampled);
    color_ = gl::Texture(GL_RGBA32F, plain);
    data_ = gl::Texture(GL_RGBA32F, plain);
    picture_ = gl::Texture(GL_RGBA8, plain);
    kinds_ = gl::Texture(GL_DEPTH_COMPONENT32F, plain);
    if (aov) {
        scene_data_ = gl::Texture(GL_RGBA16F, multisampled);
        scene_tangent_ = gl::Texture(GL_RGBA16F, multisampled);
        scene_normal_ = gl::Texture(GL_RGBA16F, multisampled);
        tangent_ = gl::Texture(GL_RGBA16F, plain);
        normal_ = gl::Texture(GL_RGBA16F, plain);
        scene_ = gl::Framebuffer({&scene_color_, &scene_data_, &scene_tangent_, &scene_normal_},
                                 &scene_depth_);
        resolved_ = gl::Framebuffer({&color_, &data_, &tangent_, &normal_}, &kinds_);
    } else {
        scene_ = gl::Framebuffer({&scene_color_}, &scene_depth_);
        resolved_ = gl::Framebuffer({&color_, &data_}, &kinds_);
    }
    display_ = gl::Framebuffer({&picture_}, nullptr);
    width_ = width;
    height_ = height;
    samples_ = samples;
    glGetTextureLevelParameteriv(scene_color_.id(), 0, GL_TEXTURE_SAMPLES, &real_samples_);
    real_samples_ = std::max(real_samples_, 1);
    aov_ = aov;
}

void Targets::bind_scene_textures() const {
    scene_color_.bind(TEX_RESOLVE_COLOR);
    scene_depth_.bind(TEX_RESOLVE_DEPTH);
    if (aov_) {
        scene_data_.bind(TEX_RESOLVE_DATA);
        scene_tangent_.bind(TEX_RESOLVE_TANGENT);
        scene_normal_.bind(TEX_RESOLVE_NORMAL);
    }
}

void Targets::bind_resolved_color() const {
    color_.bind(TEX_RESOLVE_COLOR);
}

void Targets::bind_resolved_textures() const {
    color_.bind(TEX_RESOLVE_COLOR);
    data_.bind(TEX_RESOLVE_DATA);
}

} // namespace sward::render
