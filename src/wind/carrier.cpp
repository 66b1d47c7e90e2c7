// SPDX-License-Identifier: Apache-2.0
#include "wind/carrier.h"

#include <cmath>

#include "base/angles.h"

namespace sward::wind {
namespace {

using base::kDegree;
constexpr double kHalfDifference_s = 0.005; // velocities are central differences over twice this

/// Place on the path with the offset that the file gives, in the frame of the path's yaw.
glm::dvec2 offset_place(const scene::Pose& pose, glm::dvec2 offset) {
    const base::Heading heading(pose.yaw_deg);
    return glm::dvec2(pose.position.x, pose.position.z) + heading.right() * offset.x +
           heading.back() * offset.y;
}

} // namespace

Carried carried_at(const scene::WindPlace& place, const Paths& paths, double time_s) {
    Carried out;
    out.place = place.place;
    out.yaw_deg = place.yaw_deg;
    if (place.path.empty())
        return out;
    const scene::Path& path = paths.at(place.path);
    const scene::Pose now = scene::sample_path(path, time_s);
    const scene::Pose before = scene::sample_path(path, time_s - kHalfDifference_s);
    const scene::Pose after = scene::sample_path(path, time_s + kHalfDifference_s);
    out.place = offset_place(now, place.place);
    out.velocity = (offset_place(after, place.place) - offset_place(before, place.place)) /
                   (2 * kHalfDifference_s);
    out.yaw_deg += now.yaw_deg;
    out.turn_rad_s =
        std::remainder(after.yaw_deg - before.yaw_deg, 360.0) * kDegree / (2 * kHalfDifference_s);
    out.height_m = now.position.y;
    out.agl = now.agl;
    return out;
}

} // namespace sward::wind
