// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "gl/texture.h"
#include "scene/heightfield.h"

namespace sward::terrain {

/// A landcover's bytes as TEX_LAND_COVER and TEX_LAND_GROUND, with mips that are means; one texel
/// of soil where the mask has none.
[[nodiscard]] std::array<gl::Texture, 2> land_textures(const scene::DensityMask& mask);

/// What a texture shows beyond its edge.
void go_on_with(gl::Texture& texture, glm::vec4 colour);

/// FrameConstants::land of a mask of `size_m`.
[[nodiscard]] glm::vec4 land_constants(const scene::DensityMask& mask, glm::dvec2 size_m);

} // namespace sward::terrain
