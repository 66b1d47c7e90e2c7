// SPDX-License-Identifier: Apache-2.0
#include "blades/depth_pyramid.h"

#include <algorithm>
#include <bit>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::blades {

namespace {

int padded_half(int pixels) {
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(1, (pixels + 1) / 2))));
}

void write_level(const gl::Texture& levels, int level) {
    const int width = std::max(levels.shape().width >> level, 1),
              height = std::max(levels.shape().height >> level, 1);
    glBindImageTexture(0, levels.id(), level, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
    glDispatchCompute(static_cast<GLuint>((width + PYRAMID_GROUP - 1) / PYRAMID_GROUP),
                      static_cast<GLuint>((height + PYRAMID_GROUP - 1) / PYRAMID_GROUP), 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

} // namespace

DepthPyramid::DepthPyramid()
    : first_("depth pyramid", {"blades/depth_pyramid.comp"}, {"FIRST"}),
      first_multisampled_("depth pyramid", {"blades/depth_pyramid.comp"},
                          {"FIRST", "MULTISAMPLED"}),
      next_("depth pyramid", {"blades/depth_pyramid.comp"}) {}

void DepthPyramid::build(const gl::Texture& depth, int samples) {
    const gl::TextureShape& shape = depth.shape();
    if (shape.width != width_ || shape.height != height_) {
        width_ = shape.width;
        height_ = shape.height;
        gl::TextureShape pyramid{padded_half(width_), padded_half(height_)};
        pyramid.mips =
            std::bit_width(static_cast<unsigned>(std::max(pyramid.width, pyramid.height)));
        levels_ = gl::Texture(GL_R32F, pyramid);
        levels_.set_filter(GL_NEAREST_MIPMAP_NEAREST, GL_NEAREST);
    }
    depth.bind(TEX_RESOLVE_DEPTH);
    levels_.bind(TEX_DEPTH_PYRAMID);
    gl::Program& first = shape.samples > 0 ? first_multisampled_ : first_;
    first.use();
    if (shape.samples > 0) {
        first.set("samples", samples);
    }
    write_level(levels_, 0);
    next_.use();
    for (int level = 1; level < levels_.shape().mips; ++level) {
        next_.set("level", level);
        write_level(levels_, level);
    }
}

void DepthPyramid::reload() {
    first_.reload();
    first_multisampled_.reload();
    next_.reload();
}

} // namespace sward::blades
