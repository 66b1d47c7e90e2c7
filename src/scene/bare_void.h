// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::scene {

/// Whether a value of a raster of floats stands for "no height", in values that are metres already:
/// what is_void() has, the largest floats, NaN and, where the file names no number of its own
/// (`declared`), -9999, -99999 and the least 32-bit integer.
[[nodiscard]] bool is_bare_void(float value, bool declared);

} // namespace sward::scene
