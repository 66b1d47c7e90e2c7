// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/mesh.h"

namespace sward::fly {

/// A ring of a fuselage: its place along z, half its width, its lower and upper edge (m).
struct Ring {
    double z, half, low, high;
};

/// A body between two rings, closed at both ends.
void add_body(scene::Mesh& mesh, const Ring& front, const Ring& rear);
/// A box from one corner to the other.
void add_box(scene::Mesh& mesh, const glm::dvec3& low, const glm::dvec3& high);

} // namespace sward::fly
