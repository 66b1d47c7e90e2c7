// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace sward::assets {

/// By the first bytes: the number of columns comes first in every such file.
[[nodiscard]] bool is_ascii_grid(std::span<const std::byte> head);

/// The values of an Arc/Info ASCII grid of `width` x `height`, NaN where it has none (NODATA_value,
/// by default -9999). Every word must be a number in the C locale's form; throws
/// base::Error(kBadInput) naming file and line for any other, and for too few or too many. Where
/// the grid lies is GDAL's to read.
[[nodiscard]] std::vector<float> read_ascii_grid(const std::filesystem::path& path, int width,
                                                 int height);

} // namespace sward::assets
