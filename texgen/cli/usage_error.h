// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace sward::texgen {

/// "<option>: found "<found>", expected <expected>", exit code 2.
[[nodiscard]] base::Error usage(std::string_view option, std::string_view found,
                                std::string_view expected);

/// CLI11's complaint in our words. CLI11 names what it could not place from the last to the first:
/// a wrong option's value before the option.
[[nodiscard]] base::Error usage_error(const CLI::App& app, const CLI::ParseError& problem);

} // namespace sward::texgen
