// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace sward::assets {

/// The values of an Arc/Info ASCII grid of `width` x `height`, NaN where it has none (NODATA_value, by default -9999). Every word
/// must be a number in the C locale's form; throws base::Error(kBadInput) naming file and line for any other, and for too few or
/// too many. Where the grid lies is GDAL's to read.
[[nodiscard]] std::vector<float> read_ascii_grid(const std::filesystem::path& path, int width, int height);

} // namespace sward::assets
