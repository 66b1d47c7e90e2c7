// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::base {

/// Removes pending outputs, as a signal does, and ends the process with `code`, unwinding nothing:
/// where another thread is in the middle of work that cannot be stopped. Children that were told to
/// (run_program) end too.
[[noreturn]] void end_at_once(int code);

} // namespace sward::base
