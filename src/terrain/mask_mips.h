// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sward::terrain {

/// The next mip of a picture of one channel: each texel the mean of exactly the area that it
/// covers, for odd sizes too (their texels lie across three of the finer ones). `size` becomes the
/// mip's.
[[nodiscard]] std::vector<float> next_mip(const std::vector<float>& texels, glm::ivec2& size);

/// The same of bytes of four channels.
[[nodiscard]] std::vector<std::uint8_t> next_mip(const std::vector<std::uint8_t>& texels,
                                                 glm::ivec2& size);

/// Mips down to 1 x 1, the first included.
[[nodiscard]] int mip_count(glm::ivec2 size);

} // namespace sward::terrain
