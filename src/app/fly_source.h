// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "app/pose_source.h"
#include "fly/helicopter_spec.h"

namespace sward::app {

/// The aircraft that --fly names: one that ships, or a preset's file. Throws Error.
[[nodiscard]] fly::AircraftSpec find_aircraft(const std::string& name);

/// An aeroplane under the keyboard: W and S push and pull the stick, A and D bank, Q and E are the
/// pedals, U and J the throttle. It begins where the pose stands: flying, or on its wheels where
/// that is near the ground. It flies in simulated time.
[[nodiscard]] std::unique_ptr<PoseSource> make_fly_source(const fly::AeroplaneSpec& spec);

} // namespace sward::app
