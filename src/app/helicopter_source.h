// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "app/pose_source.h"
#include "fly/helicopter_spec.h"

namespace sward::app {

/// A helicopter under the keyboard: W and S push and pull the stick, A and D bank, Q and E are the
/// pedals, U and J the collective lever, N the engine. It begins where the pose stands: in a hover,
/// or on its skids where that is near the ground. It flies in simulated time.
[[nodiscard]] std::unique_ptr<PoseSource> make_helicopter_source(const fly::HelicopterSpec& spec);

} // namespace sward::app
