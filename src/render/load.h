// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/access.h"
#include "scene/wind_spec.h"

namespace sward::render {

inline constexpr int kLoadSteps = 5;

/// The next step of a field's loading; returns the share that is left. After the last it does
/// nothing. Throws base::Error; the step may be tried again.
double load_step(FieldInside& field);

/// Throw base::Error(kBadInput): for arrows whose parents are missing or in a ring, or whose
/// numbers are out of range; for textures of another shape.
void check_arrows(const std::vector<scene::WindArrow>& arrows);
/// The wind's source that a host's blower is, as at `time_s`. Throws likewise.
[[nodiscard]] scene::MovingWindSource source_of(const Blower& blower, double time_s);
void check_textures(const HostTextures& host, int width, int height);

} // namespace sward::render
