// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sward::app {

inline constexpr std::size_t kMostRecent = 9;

/// The list with `scene` first, each once, kMostRecent at most.
[[nodiscard]] std::vector<std::filesystem::path>
with_recent(std::vector<std::filesystem::path> list, const std::filesystem::path& scene);
/// A line a scene, the newest first. What is not an absolute path, or has control characters, is
/// left out: the file is anybody's.
[[nodiscard]] std::vector<std::filesystem::path> parse_recent(std::string_view text);
[[nodiscard]] std::string format_recent(const std::vector<std::filesystem::path>& list);

/// The scenes of `file` (recent_file()); none where it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> read_recent(const std::filesystem::path& file);
/// Puts a scene first in it. A list that cannot be written is no trouble: it is said where one asks
/// for more (-v).
void note_recent(const std::filesystem::path& file, const std::filesystem::path& scene);

} // namespace sward::app
