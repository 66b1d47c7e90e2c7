// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace sward::app {

/// Runs a program (no shell) with empty stdin and our stderr for both outputs, and waits for it. It
/// is told to end when we do. Returns its exit code. Throws Error: kIo when it cannot be started,
/// kFailure where a signal ended it.
/// With `listen`, what it prints comes by way of us: on to our stderr, and line by line to
/// `listen`.
[[nodiscard]] int run_program(const std::filesystem::path& program,
                              const std::vector<std::string>& arguments,
                              const std::function<void(std::string_view line)>& listen = {});

} // namespace sward::app
