// SPDX-License-Identifier: Apache-2.0
// BC4 and BC5 (RGTC) blocks: one or two channels of 4 x 4 texels (Khronos Data Format 1.3, chapter
// RGTC).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "grass/grass_set.h"

namespace sward::grass {

using Bc4Block = std::array<std::uint8_t, 8>;

/// A channel of 4 x 4 texels, row-major, 0..255. Texels whose bit in `used` is 0 may become
/// anything. The end points are searched for from the extremes inward and outward, so that the sum
/// of squares is near the least that the format can hold; values within a span of 7 are kept
/// exactly.
[[nodiscard]] Bc4Block encode_bc4(std::span<const std::uint8_t, 16> values, std::uint16_t used);

/// The eight values of a block's palette, 0..1, as the format defines them.
[[nodiscard]] std::array<double, 8> bc4_palette(std::uint8_t end0, std::uint8_t end1);
/// Place in the palette of texel i.
[[nodiscard]] int bc4_index(const Bc4Block& block, int i);
/// Values rounded to the nearest of 0..255.
[[nodiscard]] std::array<std::uint8_t, 16> decode_bc4(const Bc4Block& block);

/// The shape planes of an array of id and shape planes (shaders/shared/grass_layout.h) as BC5:
/// image 2 i is the tangent (RG) of image i, image 2 i + 1 its root offset (BA). Texels of no
/// coverage are left out of the fit.
[[nodiscard]] TextureArray empty_shapes(const TextureArray& planes);
/// Fills the two images of image `i`, all mips, and puts what they decode to into `planes`, so that
/// it is what a reader gets. Different images may be filled from different threads.
void compress_shape(TextureArray& planes, int i, TextureArray& shapes);

/// The id planes alone.
[[nodiscard]] TextureArray id_planes(const TextureArray& planes);
/// Both planes from ids and shapes; the inverse of the two above. The sizes must agree.
[[nodiscard]] TextureArray join_planes(const TextureArray& ids, const TextureArray& shapes);

} // namespace sward::grass
