// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fly/aeroplane_spec.h"
#include "scene/mesh.h"

namespace sward::fly {

/// What is seen of an aeroplane of a preset's measures, in its own frame (x right, y up, z behind;
/// the origin is the centre of mass): fuselage, high wing, tail and wheels. Nothing of the fuselage
/// stands higher than the pilot's chin, so that the view ahead is free.
[[nodiscard]] scene::Mesh aeroplane_mesh(const AeroplaneSpec& spec);

} // namespace sward::fly
