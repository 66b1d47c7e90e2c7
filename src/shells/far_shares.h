// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "grass/grass_set.h"
#include "shared/frame.h"

namespace sward::shells {

constexpr float kSlicesBelow_deg =
    20; ///< G3: slices stand in for the shells' sides within so much of grazing

/// Share of the slices at a view elevation (radians), linear between the set's rows.
[[nodiscard]] float slice_share_at(const grass::GrassSet& set, float elevation);

/// Share of the shells' blades that far levels 0 to 3 show at a view elevation (radians), likewise.
[[nodiscard]] glm::vec4 shell_share_at(const grass::GrassSet& set, float elevation);

/// As texgen fitted them, so that shells and slices together cover what the blades cover (`--far
/// planes`).
[[nodiscard]] shared::FarShares fitted_shares(const grass::GrassSet& set);

/// As published: every shell whole (B1), slices near grazing alone (G3); where both stand they
/// cover twice (`--far published`).
[[nodiscard]] shared::FarShares published_shares();

} // namespace sward::shells
