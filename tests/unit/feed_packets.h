// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace sward::feed::tests {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kFoot_m = 0.3048;

using Bytes = std::vector<std::byte>;

/// A packet as it is written down: field after field, most significant byte first.
class Writer {
public:
    Writer& u32(std::uint32_t value, int times = 1) {
        for (; times > 0; --times)
            put(value, 4);
        return *this;
    }
    Writer& f32(double value, int times = 1) {
        return u32(std::bit_cast<std::uint32_t>(static_cast<float>(value)), times);
    }
    Writer& f32(glm::dvec3 v) { return f32(v.x).f32(v.y).f32(v.z); }
    Writer& f64(double value, int times = 1) {
        for (; times > 0; --times)
            put(std::bit_cast<std::uint64_t>(value), 8);
        return *this;
    }
    Bytes bytes;

private:
    void put(std::uint64_t value, int size) {
        for (int i = size - 1; i >= 0; --i)
            bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
    }
};

struct Said {
    std::uint32_t version = 24;
    double latitude_deg = 50, longitude_deg = 10, altitude_m = 300;
    glm::dvec3 attitude_deg{0}, rates_deg{0}; ///< roll, pitch, heading
    glm::dvec3 velocity_mps{0};               ///< north, east, down
    std::uint32_t time = 1234567890;          ///< as JSBSim sends where it is not told otherwise
};

/// net_fdm of that, the rest of it filled with numbers that must not be mistaken for any of it.
inline Bytes packet_of(const Said& said) {
    Writer w;
    w.u32(said.version).u32(0xdeadbeef);
    w.f64(said.longitude_deg * kDegree).f64(said.latitude_deg * kDegree).f64(said.altitude_m);
    w.f32(111); // above ground
    w.f32(said.attitude_deg * kDegree);
    w.f32(112, 2); // alpha, beta
    w.f32(said.rates_deg * kDegree);
    w.f32(113, 2); // calibrated airspeed, rate of climb
    w.f32(said.velocity_mps / kFoot_m);
    w.f32(114, 3).f32(115, 3).f32(116, 2); // body velocity; accelerations; stall warning, slip
    w.u32(4).u32(2, 4).f32(117, 4 * 9);    // engines
    w.u32(4).f32(118, 4);                  // tanks
    if (said.version == 25)
        w.u32(1, 4).f64(119, 4 * 4);
    w.u32(3).u32(1, 3).f32(120, 3 * 3); // wheels
    w.u32(said.time).u32(0).f32(25000); // time, warp, visibility
    w.f32(121, 10);                     // surfaces
    return w.bytes;
}

} // namespace sward::feed::tests
