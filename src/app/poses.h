// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/scene.h"

namespace sward::app {

/// The pose that --camera names: a camera of the scene, or a pose written out. Empty: the scene's
/// camera "default", else "road", else the first by name, else eye height over the middle. Throws
/// Error(kUsage) that lists the scene's cameras.
[[nodiscard]] scene::Pose find_camera(const scene::Scene& scene, const std::string& camera);

/// The path that --path names. Throws Error(kUsage) that lists the scene's paths.
[[nodiscard]] const scene::Path& find_path(const scene::Scene& scene, const std::string& name);

} // namespace sward::app
