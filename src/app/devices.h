// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/input.h"
#include "input/control_map.h"

namespace sward::app {

/// What a button of controls.toml may do, by name: every action of the keys but the editor's,
/// `camera_1` to `camera_9`, `hand_brake`.
[[nodiscard]] std::span<const std::string> button_actions();
/// The press that such a name is; none for `hand_brake`, which is held.
[[nodiscard]] std::optional<Press> press_named(std::string_view name);

/// What the user's devices do: controls.toml, or nothing bound where there is none. Throws
/// Error(kBadInput) with file, line and key.
[[nodiscard]] input::ControlMap load_device_controls();

/// Adds what devices ask for to what keys and mouse do.
void add_devices(const input::ControlReader& devices, Input& input);

} // namespace sward::app
