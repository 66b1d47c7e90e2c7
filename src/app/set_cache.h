// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/load_told.h"
#include "grass/grass_set.h"
#include "scene/scene.h"

namespace sward::app {

/// The grass set of a scene. A preset is baked on first use by texgen and kept under the hash of
/// its text; a cache that is damaged, or older than texgen itself, is baked again. The core build
/// takes sets that are baked already. Throws Error, or AlreadyReported where texgen has told what
/// went wrong.
[[nodiscard]] grass::GrassSet load_grass(const scene::Scene& scene, const LoadTold& told = {});

} // namespace sward::app
