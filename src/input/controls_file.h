// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "input/control_map.h"

namespace sward::input {

/// Reads controls.toml (docs/controls.md). Throws Error with file, line, key, found and expected:
/// kBadInput; kOverLimit.
[[nodiscard]] ControlMap parse_controls(const std::string& text, const std::filesystem::path& file);
/// The same from a file; nothing bound where there is none. Throws Error(kIo) too.
[[nodiscard]] ControlMap load_controls(const std::filesystem::path& file);

/// Throws Error(kBadInput) that names the first action which is not one of `known`, and the nearest
/// that is.
void check_actions(const ControlMap& map, std::span<const std::string> known,
                   const std::filesystem::path& file);

/// As a file: parse_controls(format_controls(map)) is the map.
[[nodiscard]] std::string format_controls(const ControlMap& map);
/// Writes it whole or not at all; makes the folder where it is missing. Throws Error(kIo).
void save_controls(const ControlMap& map, const std::filesystem::path& file);

/// $XDG_CONFIG_HOME/sward/controls.toml, by default ~/.config/sward/controls.toml; empty where
/// there is neither.
[[nodiscard]] std::filesystem::path controls_file();

} // namespace sward::input
