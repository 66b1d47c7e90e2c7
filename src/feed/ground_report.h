// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/ground_cover.h"

namespace sward::feed {

inline constexpr std::uint32_t kReportVersion = 1;
inline constexpr std::size_t kReportBytes = 96;

/// What lies under the aircraft. The numbers are the packet's own.
enum class SurfaceClass : std::uint32_t {
    kUnknown = 0, ///< beyond the terrain, or a scene that does not say
    kBare = 1,    ///< soil, or of unknown kind: grass on less than 5 % of what could stand
    kSparse = 2,  ///< less than half
    kGrass = 3,
    kRock = 4, ///< these are bare too
    kSand = 5,
    kGravel = 6,
    kAsphalt = 7,
    kWater = 8,
};
[[nodiscard]] SurfaceClass class_of(const scene::GroundCover& cover);

/// What Sward sends back once a picture.
struct GroundReport {
    std::uint32_t count = 0; ///< one more each packet; runs over
    bool fed = false;        ///< of a net_fdm packet: the next three are its own
    double latitude_deg = 0, longitude_deg = 0;
    std::uint32_t fdm_time = 0;
    bool stands = false;        ///< the stream of net_fdm stands still
    double time_s = 0;          ///< simulated
    glm::dvec2 place{0};        ///< world x, z
    double ground_m = 0;        ///< above the datum
    glm::dvec3 normal{0, 1, 0}; ///< of the ground, world
    SurfaceClass surface = SurfaceClass::kUnknown;
    glm::dvec3 wind_mps{0}; ///< that the air moves with, world: east, up, south
};

/// The packet of docs/simulator-integration.md, network byte order.
[[nodiscard]] std::array<std::byte, kReportBytes> encode_report(const GroundReport& report);

} // namespace sward::feed
