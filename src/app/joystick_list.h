// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::app {

/// `sward view --list-joysticks`: on stdout what is plugged in, a line each, and what controls.toml
/// does with it; for what is not in there, the lines to begin with. Needs no display. Throws Error
/// for a file that cannot be read.
void list_joysticks();

} // namespace sward::app
