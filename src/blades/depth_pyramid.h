// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/program.h"
#include "gl/texture.h"

namespace sward::blades {

/// Farthest depth of the opaque scene over ever larger squares of pixels, for occlusion culling
/// (J7; the pyramid in the manner of Greene's hierarchical Z, 1993). Depth is reversed, so the
/// farthest is the least. A texel of level k stands for 2^(k + 1) pixels a side; its sides are
/// powers of two, those beyond the picture repeat its rim. 4/3 bytes a pixel.
class DepthPyramid {
public:
    DepthPyramid();
    /// From a depth texture with as many `samples` (1: none). Programs that ask
    /// shaders/lib/occlusion.glsl then see it.
    void build(const gl::Texture& depth, int samples);
    [[nodiscard]] const gl::Texture& texture() const { return levels_; }
    void reload();

private:
    gl::Program first_, first_multisampled_, next_;
    gl::Texture levels_;
    int width_ = 0, height_ = 0;
};

} // namespace sward::blades
