// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

namespace sward::base {

inline constexpr double kDegree = std::numbers::pi / 180; ///< in radians

/// A turn by the compass, as files and options write it: yaw 0 looks north (-z), positive to the
/// east (+x). A body's own axes are x to its right and z to its back.
class Heading {
public:
    explicit Heading(double yaw_deg)
        : cosine_(std::cos(yaw_deg * kDegree)), sine_(std::sin(yaw_deg * kDegree)) {}

    // Of the body's axes the place on the ground: x, z.
    [[nodiscard]] glm::dvec2 right() const { return {cosine_, sine_}; }
    [[nodiscard]] glm::dvec2 back() const { return {-sine_, cosine_}; }
    [[nodiscard]] glm::dvec2 ahead() const { return {sine_, -cosine_}; }
    /// From the body's frame to the world's.
    [[nodiscard]] glm::dmat3 turn() const {
        return {{cosine_, 0, sine_}, {0, 1, 0}, {-sine_, 0, cosine_}};
    }

private:
    double cosine_, sine_;
};

/// Unit vector of a line of sight; pitch positive looks up. Of the sun: azimuth and elevation.
[[nodiscard]] inline glm::dvec3 direction_of(double yaw_deg, double pitch_deg) {
    const glm::dvec2 ahead = Heading(yaw_deg).ahead();
    const double level = std::cos(pitch_deg * kDegree);
    return {ahead.x * level, std::sin(pitch_deg * kDegree), ahead.y * level};
}

} // namespace sward::base
