// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

// Where sward finds what ships with it, and where it keeps what it makes. Nothing here touches a
// file.
namespace sward::app {

/// <exe>/../share/sward where sward is installed, else the source tree it was built from.
[[nodiscard]] std::filesystem::path data_directory();
/// The scene that `sward view` opens where none is given.
[[nodiscard]] std::filesystem::path default_scene();
/// The presets that scenes may name without shipping them.
[[nodiscard]] std::filesystem::path presets_directory();
/// The vehicles that ship.
[[nodiscard]] std::filesystem::path vehicles_directory();
/// The aircraft that ship.
[[nodiscard]] std::filesystem::path aircraft_directory();
/// The generator that bakes them: it stands beside sward.
[[nodiscard]] std::filesystem::path texgen_program();
/// $XDG_CACHE_HOME/sward/sets, by default ~/.cache/sward/sets. Throws Error(kIo) where there is
/// neither.
[[nodiscard]] std::filesystem::path set_cache_directory();
/// Beside it: meshes packed with balls.
[[nodiscard]] std::filesystem::path sphere_cache_directory();
/// $XDG_STATE_HOME/sward/recent-scenes, by default ~/.local/state/sward/recent-scenes; empty where
/// there is neither.
[[nodiscard]] std::filesystem::path recent_file();

} // namespace sward::app
