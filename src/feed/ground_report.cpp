// SPDX-License-Identifier: Apache-2.0
#include "feed/ground_report.h"

#include <span>

#include "base/angles.h"
#include "feed/network_order.h"

namespace sward::feed {
namespace {

using base::kDegree;
constexpr double kSparseShare = 0.5;
constexpr std::uint32_t kMagic = 0x53574744; // "SWGD"
constexpr std::uint32_t kFed = 1, kStands = 2;

void write_floats(std::span<std::byte> packet, std::size_t offset, glm::dvec3 value) {
    write_big_endian(packet, offset, static_cast<float>(value.x));
    write_big_endian(packet, offset + 4, static_cast<float>(value.y));
    write_big_endian(packet, offset + 8, static_cast<float>(value.z));
}

} // namespace

SurfaceClass class_of(const scene::GroundCover& cover) {
    using scene::GroundKind;
    if (!cover.known)
        return SurfaceClass::kUnknown;
    if (!cover.bare())
        return cover.grass < kSparseShare ? SurfaceClass::kSparse : SurfaceClass::kGrass;
    switch (cover.ground) {
    case GroundKind::kRock:
        return SurfaceClass::kRock;
    case GroundKind::kSand:
        return SurfaceClass::kSand;
    case GroundKind::kGravel:
        return SurfaceClass::kGravel;
    case GroundKind::kAsphalt:
        return SurfaceClass::kAsphalt;
    case GroundKind::kWater:
        return SurfaceClass::kWater;
    case GroundKind::kSoil:
        break;
    }
    return SurfaceClass::kBare;
}

std::array<std::byte, kReportBytes> encode_report(const GroundReport& report) {
    std::array<std::byte, kReportBytes> packet{};
    const std::span<std::byte> out(packet);
    write_big_endian(out, 0, kMagic);
    write_big_endian(out, 4, kReportVersion);
    write_big_endian(out, 8, report.count);
    write_big_endian(out, 12, (report.fed ? kFed : 0) | (report.stands ? kStands : 0));
    write_big_endian(out, 16, report.time_s);
    write_big_endian(out, 24, report.fed ? report.longitude_deg * kDegree : 0.0);
    write_big_endian(out, 32, report.fed ? report.latitude_deg * kDegree : 0.0);
    write_big_endian(out, 40, report.place.x);
    write_big_endian(out, 48, report.place.y);
    write_big_endian(out, 56, report.ground_m);
    // As flight models have it: north, east, down.
    write_floats(out, 64, {-report.normal.z, report.normal.x, -report.normal.y});
    write_floats(out, 76, {-report.wind_mps.z, report.wind_mps.x, -report.wind_mps.y});
    write_big_endian(out, 88, static_cast<std::uint32_t>(report.surface));
    write_big_endian(out, 92, report.fed ? report.fdm_time : 0u);
    return packet;
}

} // namespace sward::feed
