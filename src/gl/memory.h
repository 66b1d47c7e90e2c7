// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sward::gl {

/// Bytes of buffers and textures alive, as asked for (padding of the driver not counted). One
/// thread owns the context.
[[nodiscard]] std::uint64_t gpu_bytes();
void count_gpu_bytes(std::int64_t delta);

} // namespace sward::gl
