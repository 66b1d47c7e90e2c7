// SPDX-License-Identifier: Apache-2.0
#include "feed/net_fdm.h"

#include <cmath>
#include <initializer_list>

#include "base/angles.h"
#include "feed/network_order.h"
#include "scene/ranges.h"

namespace sward::feed {
namespace {

using base::kDegree;
constexpr double kFoot_m = 0.3048;
constexpr double kSteepest_rad = 90.001 * kDegree; // floats round past the pole
constexpr double kTurn_rad = 360.001 * kDegree;
constexpr double kFastest_mps = 1e4; // an orbit

// Offsets in bytes. Tanks, gear and surfaces lie between kVelocity and the time, at the end.
constexpr std::size_t kVersion = 0, kLongitude = 8, kLatitude = 16, kAltitude = 24;
constexpr std::size_t kAttitude = 36, kRates = 56, kVelocity = 76;
constexpr std::size_t kTimeFromEnd = 52;

glm::dvec3 three_floats(std::span<const std::byte> packet, std::size_t offset) {
    return {read_big_endian<float>(packet, offset), read_big_endian<float>(packet, offset + 4),
            read_big_endian<float>(packet, offset + 8)};
}

bool finite(const FdmSample& s) {
    for (const glm::dvec3& v : {glm::dvec3(s.latitude_deg, s.longitude_deg, s.altitude_m),
                                s.attitude_rad, s.attitude_rates, s.velocity_mps})
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            return false;
    return true;
}

bool within(double value, const scene::Range& range) {
    return value >= range.low && value <= range.high;
}

/// Rates may be any finite number: heading and roll spin where the nose points straight up.
bool plausible(const FdmSample& s) {
    for (const double v : {s.velocity_mps.x, s.velocity_mps.y, s.velocity_mps.z})
        if (std::abs(v) > kFastest_mps)
            return false;
    return within(s.latitude_deg, scene::kLatitude) && within(s.longitude_deg, scene::kLongitude) &&
           within(s.altitude_m, scene::kHeight) && std::abs(s.attitude_rad.x) <= kTurn_rad &&
           std::abs(s.attitude_rad.y) <= kSteepest_rad && std::abs(s.attitude_rad.z) <= kTurn_rad;
}

} // namespace

DecodedFdm decode_fdm(std::span<const std::byte> packet) {
    if (packet.size() < kVersion + 4)
        return {FdmFault::kSize, {}};
    const auto version = read_big_endian<std::uint32_t>(packet, kVersion);
    if (version != 24 && version != 25)
        return {FdmFault::kVersion, {}};
    if (packet.size() != (version == 24 ? kFdm24Bytes : kFdm25Bytes))
        return {FdmFault::kSize, {}};
    FdmSample s;
    s.longitude_deg = read_big_endian<double>(packet, kLongitude) / kDegree;
    s.latitude_deg = read_big_endian<double>(packet, kLatitude) / kDegree;
    s.altitude_m = read_big_endian<double>(packet, kAltitude);
    s.attitude_rad = three_floats(packet, kAttitude);
    s.attitude_rates = three_floats(packet, kRates);
    s.velocity_mps = three_floats(packet, kVelocity) * kFoot_m;
    s.time = read_big_endian<std::uint32_t>(packet, packet.size() - kTimeFromEnd);
    if (!finite(s))
        return {FdmFault::kNumber, {}};
    if (!plausible(s))
        return {FdmFault::kRange, {}};
    return {FdmFault::kNone, s};
}

} // namespace sward::feed
