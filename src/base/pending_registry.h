// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace sward::base {

/// The temporaries that stand now, for the signal cleanup. Internal to src/base; thread-safe.
void register_pending(const std::filesystem::path& temporary);
void unregister_pending(const std::filesystem::path& temporary);
/// Removes every registered temporary, file or directory. For the cleanup thread only: the process
/// must end next.
void remove_all_pending();

} // namespace sward::base
