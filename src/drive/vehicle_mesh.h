// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drive/vehicle_spec.h"
#include "scene/mesh.h"

namespace sward::drive {

/// A body of a preset's measures, in the vehicle's own frame (x right, y up, z behind; the origin
/// on the ground under its centre of mass): bonnet, boot, arches over its wheels. Nothing stands
/// higher than a belt at half its height, so that a driver sees over it.
[[nodiscard]] scene::Mesh body_mesh(const VehicleSpec& spec);
/// The roof on its pillars, without panes: one sees out of it, and into it.
[[nodiscard]] scene::Mesh roof_mesh(const VehicleSpec& spec);
/// A wheel about its hub, its axle along x.
[[nodiscard]] scene::Mesh wheel_mesh(const AxleSpec& axle);

} // namespace sward::drive
