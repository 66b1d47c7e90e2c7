// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string_view>

namespace sward::app {

/// Is told what a load does now, and the share of it that is done where that is known. Any thread
/// may call it. Empty: nobody asks.
using LoadTold = std::function<void(std::string_view what, std::optional<double> share)>;

} // namespace sward::app
