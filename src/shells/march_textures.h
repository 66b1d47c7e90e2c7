// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gl/buffer.h"
#include "gl/texture.h"
#include "grass/grass_set.h"

namespace sward::shells {

/// What the march reads of a grass set, on the GPU.
class MarchTextures {
public:
    /// A set without blades or volume (a scene on a mesh) has none. Throws Error(kOverLimit) when
    /// an array has more layers than the GPU takes.
    explicit MarchTextures(const grass::FarMedium& march);
    void bind() const;              ///< what all kinds share
    void bind_kind(int kind) const; ///< the images of one
    [[nodiscard]] bool empty() const { return !images_[0].density.id(); }

private:
    gl::Buffer medium_;
    struct Images {
        gl::Texture density, fibres;
    };
    std::array<Images, shared::kMarchSets + 1> images_; ///< by kind of march
    gl::Texture correction_;
};

} // namespace sward::shells
