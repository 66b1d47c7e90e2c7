// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/texture.h"
#include "grass/grass_set.h"

namespace sward::shells {

/// The far tier's images on the GPU, one array of layers and one of slices for each far level.
class FarTextures {
public:
    struct Level {
        gl::Texture layers, slices;
        gl::Texture layers_shape,
            slices_shape; ///< BC5, where the set has them: `layers` and `slices` are ids alone then
        int layer_count = 0;
        int slice_count = 0;
    };
    /// Throws Error(kOverLimit) when an array has more layers than the GPU takes.
    explicit FarTextures(const grass::GrassSet& set);
    [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
    [[nodiscard]] bool block_shapes() const { return block_shapes_; }

private:
    std::vector<Level> levels_;
    bool block_shapes_ = false;
};

} // namespace sward::shells
