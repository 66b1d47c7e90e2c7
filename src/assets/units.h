// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace sward::assets {

/// Metres of one vertical unit, however a driver spells it ("Metre", "METERS", "ftUS", "US survey
/// foot"); 1, and `has_unit` false, where the text names none. Nothing where it is no length.
[[nodiscard]] std::optional<double> metres_of_unit(std::string_view text, bool& has_unit);

} // namespace sward::assets
