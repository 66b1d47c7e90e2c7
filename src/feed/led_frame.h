// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "sward/field.h"

namespace sward::feed {

// What a frame may hold: more than any picture has, and little enough for a datagram.
inline constexpr std::size_t kMostLedSteps = 64, kMostLedChanges = 64, kMostLedBalls = 96,
                             kMostLedBodies = 16, kMostLedBlowers = 8;

/// What changed before a step.
struct LedChange {
    std::uint32_t step = 0; ///< of the flight
    std::variant<Sun, MeanWind> what;
};

/// What a master does to its field in a picture, and where that looks from. Whoever does the same
/// from the beginning on has the same field, bit for bit.
struct LedFrame {
    std::uint32_t count = 0; ///< start of frame: one more each picture
    bool idle = false;       ///< changes nothing in the field
    std::uint32_t place = 0; ///< frames that change the field before it
    double time_s = 0;       ///< simulated
    double hour = 12;        ///< of the day
    glm::dvec3 position{0};  ///< the eye's, above the datum
    double yaw_deg = 0, pitch_deg = 0, roll_deg = 0, fov_deg = 60;
    std::uint32_t first_step = 0;
    std::vector<glm::dvec3> eyes; ///< one a step
    std::vector<LedChange> changes;
    std::vector<Ball> balls;
    std::vector<Body> bodies;
    bool blows = false; ///< whether the next take the place of those before
    std::vector<Blower> blowers;
};

/// Appends a frame in network byte order (docs/simulator-integration.md).
void encode_frame(const LedFrame& frame, std::vector<std::byte>& out);
/// Reads the frame that begins at `at` and moves that past it. None where the bytes end before it,
/// hold more than a frame may or numbers that are none; nothing past them is looked at.
[[nodiscard]] std::optional<LedFrame> decode_frame(std::span<const std::byte> bytes,
                                                   std::size_t& at);

} // namespace sward::feed
