// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sward::base {

/// Whether so many bytes of address space may still be taken (ulimit -v). Takes none.
[[nodiscard]] bool has_room(std::size_t bytes);

/// Throws base::Error(kOverLimit) where less than `enough` bytes of address space are left, or
/// base::Error(kIo) where file handles have run out. For places where a library failed and says
/// something else: PROJ without its database knows no CRS, a driver that cannot be loaded is "no
/// GPU".
void refuse_if_starved(std::size_t enough = std::size_t{64} << 20);

} // namespace sward::base
