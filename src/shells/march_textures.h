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
    /// A set without blades or volume (a scene on a mesh) has none. Throws Error(kOverLimit) when an array has more layers than the GPU takes.
    explicit MarchTextures(const grass::FarMedium& march);
    void bind() const;
    [[nodiscard]] bool empty() const { return !columns_.id(); }

private:
    gl::Buffer medium_;
    gl::Texture columns_, correction_;
    std::array<gl::Texture, shared::kMarchSets> slabs_;
};

} // namespace sward::shells
