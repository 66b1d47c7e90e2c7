// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sward::base {

/// Exit codes of every Sward program.
enum class ExitCode : int {
    kDone = 0,
    kFailure = 1,  ///< a failure inside Sward
    kUsage = 2,    ///< bad command line
    kBadInput = 3, ///< a file or value that cannot be used
    kOverLimit = 4,
    kIo = 5,    ///< reading or writing failed
    kNoGpu = 6, ///< no usable GPU context, or a shader that does not build
};

/// Bad input or environment. what() is one complete line without the "error: " prefix.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// Text taken from a file or option, fit for a one-line message: control characters and invalid
/// UTF-8 escaped, clipped to `limit` bytes.
[[nodiscard]] std::string printable(std::string_view text, std::size_t limit = 80);

/// "<file>[:line]: <what>: found <found>, expected <expected>" as an Error. `line` 0 leaves the
/// line out.
[[nodiscard]] Error input_error(ExitCode code, const std::filesystem::path& file, int line,
                                std::string_view what, std::string_view found,
                                std::string_view expected);

/// The name in `known` that takes the fewest edits (insert, delete, replace, swap of two
/// neighbours) from `name`; empty when none is within half its length. For messages about unknown
/// keys and names.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string> known);

} // namespace sward::base
