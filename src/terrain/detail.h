// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::terrain {

/// Through a long lens the ground far away needs posts that are finer than its distance says
/// (shared::detail_reach). zoom 1: it does not.
struct Detail {
    float start_m = 0; ///< up to here blades may stand, which know the clipmap alone
    float zoom = 1;
    [[nodiscard]] bool on() const { return zoom > 1; }
    /// The least of detail_reach between two distances from the eye (m).
    [[nodiscard]] float least_reach(float nearest_m, float farthest_m) const;
};

/// Of a picture with this vertical field of view and focal length in pixels. From 20 degrees on:
/// none, and pictures as ever.
[[nodiscard]] Detail detail_of(double fov_deg, double focal_px, double blades_end_m);

} // namespace sward::terrain
