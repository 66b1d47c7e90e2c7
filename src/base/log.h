// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sward::base {

/// Everything goes to stderr; results go to stdout or files. One line a message.
enum class Verbosity { kQuiet, kNormal, kVerbose };
void set_verbosity(Verbosity verbosity);
[[nodiscard]] Verbosity verbosity();

void log_error(std::string_view message);   ///< "error: ..."; shown at every verbosity
void log_warning(std::string_view message); ///< "warning: ..."; shown at every verbosity
void log_info(std::string_view message);    ///< hidden when quiet
void log_debug(std::string_view message);   ///< shown when verbose

/// One line of at most `columns` - 1 characters: the bar, the percentage and the time left, or the
/// time it took once `share` is 1. Pure, for Progress.
[[nodiscard]] std::string progress_bar(std::string_view title, double share, double elapsed_s,
                                       std::size_t columns);

/// Progress on stderr: a bar with the time left on a terminal, a plain line at each tenth
/// otherwise, nothing when quiet. Safe to advance from several threads.
class Progress {
public:
    Progress(std::string title, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::size_t steps = 1);

private:
    struct State;
    State* state_;
};

} // namespace sward::base
