// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "render/renderer.h"

namespace sward::app {

/// Largest resident size of this process so far, bytes.
[[nodiscard]] std::uint64_t process_peak_bytes();

/// One frame's statistics as JSON text (docs/commands.md): {"gpu", "size", "passes", "blades",
/// "fragments", "bytes"}.
[[nodiscard]] std::string stats_json(const render::FrameStats& stats, const std::string& gpu,
                                     const render::FrameSettings& settings);

/// A sequence's: {"frames": [one object a frame, with its "frame" number]}. `frames` are texts of
/// stats_json.
[[nodiscard]] std::string sequence_json(const std::vector<std::string>& frames, int first);

} // namespace sward::app
