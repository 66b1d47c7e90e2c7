// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

namespace sward {

/// How much a message matters, the most first.
enum class LogLevel { kError, kWarning, kInfo, kDebug };

/// Takes one message: one line without its end, and without a prefix for its level. Called on the
/// thread that the message comes from, one call at a time; must not throw, nor log.
using LogSink = std::function<void(LogLevel, std::string_view)>;

/// Where messages of the whole process go from now on. An empty sink is the default: lines on
/// stderr, "warning: " and "error: " in front, kDebug left out.
void set_log(LogSink sink);

} // namespace sward
