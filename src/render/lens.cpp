// SPDX-License-Identifier: Apache-2.0
#include "render/lens.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"

namespace sward {
namespace {

using base::kDegree;

base::Error unfit(const char* what, const std::string& found, const char* expected) {
    return {base::ExitCode::kBadInput,
            fmt::format("camera: {}: found {}, expected {}", what, found, expected)};
}

void check(const char* what, double value, double low, double high, const char* expected) {
    if (!(value >= low && value <= high)) { // NaN too
        throw unfit(what, fmt::format("{}", value), expected);
    }
}

bool finite(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

glm::dmat4 view_from_world(const CameraPose& pose) {
    check("yaw_deg", pose.yaw_deg, -1e9, 1e9, "a finite number of degrees");
    check("pitch_deg", pose.pitch_deg, -90, 90, "-90 to 90 degrees");
    check("roll_deg", pose.roll_deg, -1e9, 1e9, "a finite number of degrees");
    const glm::dvec3 ahead = base::direction_of(pose.yaw_deg, pose.pitch_deg);
    glm::dvec3 right = base::direction_of(pose.yaw_deg + 90, 0);
    glm::dvec3 up = glm::cross(right, ahead);
    if (pose.roll_deg != 0) {
        const double c = std::cos(pose.roll_deg * kDegree), s = std::sin(pose.roll_deg * kDegree);
        const glm::dvec3 level = right;
        right = c * level - s * up;
        up = c * up + s * level;
    }
    const glm::dmat4 turn = glm::transpose(glm::dmat4(
        glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(-ahead, 0), glm::dvec4(0, 0, 0, 1)));
    return turn *
           glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, glm::dvec4(-pose.position, 1));
}

Camera camera_of(const CameraPose& pose, int width, int height) {
    check("fov_deg", pose.fov_deg, 1e-3, 179.999, "0.001 to 179.999 degrees");
    check("near_m", pose.near_m, 1e-6, 1e6, "1e-6 to 1e6 metres");
    if (width < 1 || height < 1) {
        throw unfit("size", fmt::format("{} x {}", width, height), "at least 1 x 1 pixel");
    }
    Camera camera;
    camera.view_from_world = view_from_world(pose);
    const double f = 1 / std::tan(0.5 * pose.fov_deg * kDegree);
    camera.clip_from_view = glm::dmat4(0);
    camera.clip_from_view[0][0] = f * height / width;
    camera.clip_from_view[1][1] = f;
    camera.clip_from_view[2][3] = -1;
    camera.clip_from_view[3][2] = pose.near_m;
    return camera;
}

glm::dmat4 projection(const Tangents& t, double near_m) {
    check("near_m", near_m, 1e-6, 1e6, "1e-6 to 1e6 metres");
    const double wide = t.right - t.left, high = t.top - t.bottom;
    check("tangents", std::min(std::abs(wide), std::abs(high)), 1e-9, 1e9, "sides that are apart");
    glm::dmat4 out(0);
    out[0][0] = 2 / wide;
    out[1][1] = 2 / high;
    out[2][0] = (t.right + t.left) / wide;
    out[2][1] = (t.top + t.bottom) / high;
    out[2][3] = -1;
    out[3][2] = near_m;
    return out;
}

namespace render {
namespace {

constexpr double kNoTurn = 1e-5; // what a host's floats may be off a turn by

/// The eye of a view, free of what the way there and back has rounded: a place that was a whole
/// metre is one again, whichever turn it came by.
glm::dvec3 eye_of(const glm::dmat4& view) {
    const glm::dvec3 eye = -(glm::transpose(glm::dmat3(view)) * glm::dvec3(view[3]));
    const double most = std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z), 1.0});
    const double grid = std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(most))) - 48);
    return glm::round(eye / grid) * grid;
}

void check_turn(const glm::dmat3& turn) {
    const glm::dmat3 square = glm::transpose(turn) * turn;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            if (std::abs(square[column][row] - (row == column ? 1 : 0)) > kNoTurn) {
                throw unfit("view_from_world", "a matrix that stretches or shears",
                            "a turn, or a mirroring, and a shift");
            }
        }
    }
}

} // namespace

double Lens::focal_px(int width, int height) const {
    return 0.5 *
           std::max(std::abs(clip_from_eye[0][0]) * width, std::abs(clip_from_eye[1][1]) * height);
}

Lens lens_of(const Camera& camera) {
    const glm::dmat4& view = camera.view_from_world;
    glm::dmat4 clip = camera.clip_from_view;
    if (!finite(view) || !finite(clip)) {
        throw unfit("matrices", "infinity or no number", "finite numbers");
    }
    if (view[0][3] != 0 || view[1][3] != 0 || view[2][3] != 0 || view[3][3] != 1) {
        throw unfit("view_from_world", "another last row", "0, 0, 0, 1");
    }
    check_turn(glm::dmat3(view));
    if (clip[0][3] != 0 || clip[1][3] != 0 || !(clip[2][3] < 0) || clip[3][3] != 0) {
        throw unfit("clip_from_view", "another last row", "0, 0, -1, 0: a perspective");
    }
    clip /= -clip[2][3];
    if (clip[0][0] == 0 || clip[1][1] == 0 || clip[3][0] != 0 || clip[3][1] != 0 ||
        clip[0][2] != 0 || clip[1][2] != 0) {
        throw unfit("clip_from_view", "a lens without width, shifted or tilted",
                    "a projection, on or off its axis");
    }
    Lens lens;
    lens.turn = glm::dmat4(glm::dmat3(view));
    lens.eye = eye_of(view);
    // The host's depth over the distance d along the axis is (a * -d + b) / d; nearest where it is
    // 1 reversed, else least.
    const bool half = camera.clip_depth == ClipDepth::kMinusOneToOne;
    const double a = clip[2][2], b = clip[3][2];
    const double nearest = b > 0 ? 1 : half ? -1 : 0;
    lens.near_m = b / (nearest + a);
    if (b == 0 || !(lens.near_m >= 1e-6 && lens.near_m <= 1e6)) {
        throw unfit("clip_from_view", fmt::format("a near plane {} m off", lens.near_m),
                    "1e-6 to 1e6 metres");
    }
    lens.host_depth = half ? glm::dvec2(0.5 - 0.5 * a, 0.5 * b) : glm::dvec2(-a, b);
    clip[2][2] = 0;
    clip[3][2] = lens.near_m;
    lens.clip_from_eye = clip;
    lens.fov_deg = 2 * std::atan(1 / std::abs(clip[1][1])) / kDegree;
    lens.mirrored = clip[0][0] * clip[1][1] * glm::determinant(glm::dmat3(view)) < 0;
    return lens;
}

} // namespace render
} // namespace sward
