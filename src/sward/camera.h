// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace sward {

/// World space: metres from the terrain's middle, x east, y up from the datum, z south.

/// Near plane of cameras that name no other (m). A float's value: what it gives is the same bit for
/// bit on every way to the GPU.
inline constexpr double kNear_m = 0.05f;

/// What clip coordinates hold as depth, as glClipControl says of the host's own drawing.
enum class ClipDepth {
    kZeroToOne,     ///< GL_ZERO_TO_ONE
    kMinusOneToOne, ///< GL_NEGATIVE_ONE_TO_ONE, OpenGL's default
};

/// Where a picture is seen from, and through which lens. Any place and turn, banked or mirrored;
/// any perspective projection, off its axis too, with any near plane, reversed or not, with a far
/// plane or none. What lies beyond a far plane is drawn all the same.
struct Camera {
    /// World to the eye's space (x right, y up, z behind; m): a turn, or a mirroring, and a shift.
    glm::dmat4 view_from_world{1};
    /// The eye's space to clip coordinates. Its last row is 0, 0, -1, 0; the depth that it gives a
    /// distance is that of a Target's depth textures and, at the near plane, where things are cut
    /// off. In doubles, so that a pose gives the same picture from everywhere.
    glm::dmat4 clip_from_view{1};
    ClipDepth clip_depth = ClipDepth::kZeroToOne;
};

/// A camera as people name it.
struct CameraPose {
    glm::dvec3 position{0};  ///< of the eye (m, world space)
    double yaw_deg = 0;      ///< 0 looks north (-z), positive to the east; any
    double pitch_deg = 0;    ///< positive looks up; -90 to 90
    double roll_deg = 0;     ///< positive lowers the right wing; any
    double fov_deg = 60;     ///< vertical; above 0, below 180
    double near_m = kNear_m; ///< above 0
};

/// A pose's camera for a picture of so many pixels, square ones: reversed depth without a far
/// plane, 1 at the near one. Throws Error(kBadInput) for a number out of its range.
[[nodiscard]] Camera camera_of(const CameraPose& pose, int width, int height);

/// World to the eye's space for a pose, its lens aside.
[[nodiscard]] glm::dmat4 view_from_world(const CameraPose& pose);

/// The rim of a picture as the eye sees it: tangents of the angles to its sides. Left and bottom
/// are below 0 where the axis is in view.
struct Tangents {
    double left = -1, right = 1, bottom = -1, top = 1;
};

/// A lens, centred or not, with reversed depth and no far plane. `near_m` above 0; left below
/// right, bottom below top, or the other way round to mirror. Throws Error(kBadInput) likewise.
[[nodiscard]] glm::dmat4 projection(const Tangents& tangents, double near_m = kNear_m);

} // namespace sward
