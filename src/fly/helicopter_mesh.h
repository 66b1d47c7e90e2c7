// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fly/helicopter_spec.h"
#include "scene/mesh.h"

namespace sward::fly {

/// What is seen of a helicopter of a preset's measures, in its own frame (the origin is the centre
/// of mass): cabin, mast, boom, fin and skids. Nothing stands ahead of the pilot's eye but below
/// his chin.
[[nodiscard]] scene::Mesh helicopter_mesh(const HelicopterSpec& spec);
/// Its blades, about the hub, in the plane of x and z.
[[nodiscard]] scene::Mesh rotor_mesh(const HelicopterSpec& spec);
/// The tail rotor's blades about its own hub, in the plane of y and z.
[[nodiscard]] scene::Mesh tail_rotor_mesh(const HelicopterSpec& spec);
/// Where that hub is in the helicopter's frame.
[[nodiscard]] glm::dvec3 tail_hub(const HelicopterSpec& spec);

} // namespace sward::fly
