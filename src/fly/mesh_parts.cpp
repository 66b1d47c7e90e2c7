// SPDX-License-Identifier: Apache-2.0
#include "fly/mesh_parts.h"

#include <array>
#include <cstddef>

#include "scene/mesh_build.h"

namespace sward::fly {

using glm::dvec3;
using scene::add_outward;

namespace {

std::array<dvec3, 4> corners(const Ring& ring) {
    return {dvec3(-ring.half, ring.low, ring.z), dvec3(ring.half, ring.low, ring.z),
            dvec3(ring.half, ring.high, ring.z), dvec3(-ring.half, ring.high, ring.z)};
}

} // namespace

void add_body(scene::Mesh& mesh, const Ring& front, const Ring& rear) {
    const auto a = corners(front), b = corners(rear);
    const dvec3 middle(0, (front.low + front.high + rear.low + rear.high) / 4,
                       (front.z + rear.z) / 2);
    for (std::size_t i = 0; i < 4; ++i)
        add_outward(mesh, middle, {a[i], a[(i + 1) % 4], b[(i + 1) % 4], b[i]});
    add_outward(mesh, middle, {a[0], a[1], a[2], a[3]});
    add_outward(mesh, middle, {b[0], b[1], b[2], b[3]});
}

void add_box(scene::Mesh& mesh, const dvec3& low, const dvec3& high) {
    const dvec3 middle = (low + high) / 2.0, size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 u(0), v(0);
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        for (const double side : {0.0, 1.0}) {
            dvec3 at = low;
            at[axis] += side * size[axis];
            add_outward(mesh, middle, {at, at + u, at + u + v, at + v});
        }
    }
}

} // namespace sward::fly
