// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "app/pose_source.h"
#include "drive/vehicle_spec.h"

namespace sward::app {

/// The vehicle that --drive names: one that ships, or a preset's file. Throws Error.
[[nodiscard]] drive::VehicleSpec find_vehicle(const std::string& name);

/// A vehicle under the keyboard: W and S drive and brake, A and D steer, E is the hand brake. It
/// begins where the pose stands, on the ground. It drives in simulated time. `tyres`: what it
/// stands on all over; none: what `cover` says of each wheel's place; wet grass: the same, where
/// grass is wet.
[[nodiscard]] std::unique_ptr<PoseSource> make_drive_source(const drive::VehicleSpec& spec,
                                                            std::optional<drive::Surface> tyres,
                                                            CoverAt cover);

} // namespace sward::app
