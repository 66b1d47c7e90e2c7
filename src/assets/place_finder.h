// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace sward::assets {

/// local_place() for many places, a few microseconds each: for what moves. What it returns throws
/// likewise.
[[nodiscard]] scene::PlaceOnEarth place_finder(const scene::Georeference& frame);

} // namespace sward::assets
