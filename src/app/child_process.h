// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sward::app {

/// Runs a program (no shell) with empty stdin and our stderr for both outputs, and waits for it. It
/// is told to end when we do. Returns its exit code. Throws Error: kIo when it cannot be started,
/// kFailure where a signal ended it.
[[nodiscard]] int run_program(const std::filesystem::path& program,
                              const std::vector<std::string>& arguments);

} // namespace sward::app
