// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace sward::feed {

/// FlightGear's net_fdm, a packet in network byte order; versions 24 (FlightGear up to 2020.2) and
/// 25 differ in what they say of tanks. docs/simulator-integration.md has the offsets.
inline constexpr std::size_t kFdm24Bytes = 408, kFdm25Bytes = 552;

/// What Sward takes from it.
struct FdmSample {
    double latitude_deg = 0, longitude_deg = 0; ///< geodetic, WGS 84
    double altitude_m = 0;                      ///< above sea level
    glm::dvec3 attitude_rad{
        0}; ///< roll, pitch, heading from true north: turned in the order heading, pitch, roll
    glm::dvec3 attitude_rates{0}; ///< their rates, rad/s
    glm::dvec3 velocity_mps{0};   ///< north, east, down
    std::uint32_t time = 0; ///< the sender's cur_time: seconds, a finer count, or always the same
};

enum class FdmFault {
    kNone,
    kVersion, ///< another version, or no net_fdm
    kSize,    ///< shorter or longer than its version is
    kNumber,  ///< infinite or no number
    kRange,   ///< no place, height, attitude or speed of an aircraft
};

struct DecodedFdm {
    FdmFault fault = FdmFault::kNone;
    FdmSample sample; ///< where there is no fault
};

/// Reads a packet. Looks at nothing past its end, whatever it holds.
[[nodiscard]] DecodedFdm decode_fdm(std::span<const std::byte> packet);

} // namespace sward::feed
