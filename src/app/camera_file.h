// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "sward/camera.h"

namespace sward::app {

/// A camera's matrices from JSON: {"view_from_world": [16 numbers], "clip_from_view": [16
/// numbers]}, row by row. Throws Error: kIo, kBadInput.
[[nodiscard]] Camera read_camera(const std::filesystem::path& file);

} // namespace sward::app
