// SPDX-License-Identifier: Apache-2.0
// Packets of flight models: what is read from them, which of them count, and how far a pose is
// carried on.
#include <cmath>
#include <limits>
#include <random>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "feed/ground_report.h"
#include "feed/net_fdm.h"
#include "feed/pose_track.h"
#include "feed_packets.h"

namespace sward::feed {
namespace {

using namespace tests;

constexpr double kMetresPerDegree = 100'000;

/// A flat Earth whose degrees are 100 km, about 50 north, 10 east. Its north leans by `lean_deg` to
/// the east of the frame's.
scene::PlaceOnEarth flat_earth(double lean_deg = 0) {
    const double c = std::cos(lean_deg * kDegree), s = std::sin(lean_deg * kDegree);
    return [=](double latitude, double longitude) {
        const double north = (latitude - 50) * kMetresPerDegree,
                     east = (longitude - 10) * kMetresPerDegree;
        return glm::dvec2(east * c + north * s, east * s - north * c);
    };
}

/// A flight north at 60 m/s, 60 packets a second; the sender's time is `time_step` a packet.
Said flight_at(int packet, std::uint32_t time_step = 0) {
    Said said;
    said.velocity_mps = {60, 0, 0};
    said.latitude_deg = 50 + packet * 1.0 / kMetresPerDegree;
    said.time += static_cast<std::uint32_t>(packet) * time_step;
    return said;
}

bool same(const FeedPose& a, const FeedPose& b) {
    return a.position == b.position && a.velocity_mps == b.velocity_mps && a.yaw_deg == b.yaw_deg &&
           a.pitch_deg == b.pitch_deg && a.roll_deg == b.roll_deg;
}

TEST(Fdm, BothVersionsSayWhatTheySaid) {
    for (const std::uint32_t version : {24u, 25u}) {
        Said said;
        said.version = version;
        said.latitude_deg = -33.9461;
        said.longitude_deg = 151.1772;
        said.altitude_m = 1234.5;
        said.attitude_deg = {12, -7, 271};
        said.rates_deg = {3, 2, -5};
        said.velocity_mps = {61.5, -20.25, 1.5};
        said.time = 77;
        const Bytes packet = packet_of(said);
        ASSERT_EQ(packet.size(), version == 24 ? kFdm24Bytes : kFdm25Bytes);
        const DecodedFdm read = decode_fdm(packet);
        ASSERT_EQ(read.fault, FdmFault::kNone);
        EXPECT_NEAR(read.sample.latitude_deg, said.latitude_deg, 1e-12);
        EXPECT_NEAR(read.sample.longitude_deg, said.longitude_deg, 1e-12);
        EXPECT_EQ(read.sample.altitude_m, said.altitude_m);
        EXPECT_LT(glm::length(read.sample.attitude_rad / kDegree - said.attitude_deg), 1e-4);
        EXPECT_LT(glm::length(read.sample.attitude_rates / kDegree - said.rates_deg), 1e-5);
        EXPECT_LT(glm::length(read.sample.velocity_mps - said.velocity_mps), 1e-5);
        EXPECT_EQ(read.sample.time, 77u);
    }
}

TEST(Fdm, NoOtherSizeAndNoOtherVersionIsRead) {
    for (const std::uint32_t version : {24u, 25u}) {
        Said said;
        said.version = version;
        const Bytes whole = packet_of(said);
        for (std::size_t size = 0; size < 700; ++size) {
            Bytes cut(whole.begin(),
                      whole.begin() + static_cast<std::ptrdiff_t>(std::min(size, whole.size())));
            cut.resize(size);
            EXPECT_EQ(decode_fdm(cut).fault,
                      size == whole.size() ? FdmFault::kNone : FdmFault::kSize)
                << size;
        }
    }
    for (const std::uint32_t version :
         {0u, 23u, 26u, 0x18000000u, 0xffffffffu}) { // the fourth: 24 in the other byte order
        Said said;
        said.version = version;
        EXPECT_EQ(decode_fdm(packet_of(said)).fault, FdmFault::kVersion) << version;
    }
}

TEST(Fdm, NumbersThatAreNoneAndPlacesThatAreNoneAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    const auto fault = [](auto change) {
        Said said;
        change(said);
        return decode_fdm(packet_of(said)).fault;
    };
    for (const double bad : {nan, inf, -inf}) {
        EXPECT_EQ(fault([&](Said& s) { s.latitude_deg = bad; }), FdmFault::kNumber);
        EXPECT_EQ(fault([&](Said& s) { s.longitude_deg = bad; }), FdmFault::kNumber);
        EXPECT_EQ(fault([&](Said& s) { s.altitude_m = bad; }), FdmFault::kNumber);
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(fault([&](Said& s) { s.attitude_deg[i] = bad; }), FdmFault::kNumber);
            EXPECT_EQ(fault([&](Said& s) { s.rates_deg[i] = bad; }), FdmFault::kNumber);
            EXPECT_EQ(fault([&](Said& s) { s.velocity_mps[i] = bad; }), FdmFault::kNumber);
        }
    }
    EXPECT_EQ(fault([](Said& s) { s.latitude_deg = 90.1; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.longitude_deg = -1e300; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.altitude_m = 1e300; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.attitude_deg.y = 91; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.attitude_deg.z = 1000; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.velocity_mps.y = 2e4; }), FdmFault::kRange);
    EXPECT_EQ(fault([](Said& s) { s.attitude_deg.y = -90; }), FdmFault::kNone);
    EXPECT_EQ(fault([](Said& s) { s.rates_deg.z = 1e9; }), FdmFault::kNone); // straight up
}

TEST(PoseTrack, StandsWhereThePacketSaysAndGoesOnForATenthOfASecond) {
    PoseTrack track(flat_earth());
    EXPECT_FALSE(track.pose(0));
    EXPECT_EQ(track.stream(0), Stream::kWaiting);
    Said said = flight_at(0);
    said.longitude_deg = 10.01;
    said.velocity_mps = {60, 8, -2};
    said.attitude_deg = {5, 4, 7.5};
    ASSERT_EQ(track.take(packet_of(said), "a", 100), Packet::kTaken);
    const FeedPose at = *track.pose(100);
    EXPECT_LT(glm::length(at.position - glm::dvec3(1000, 300, 0)), 1e-6);
    EXPECT_NEAR(at.yaw_deg, 7.5, 1e-5);
    EXPECT_NEAR(at.pitch_deg, 4, 1e-5);
    EXPECT_NEAR(at.roll_deg, 5, 1e-5);
    EXPECT_LT(
        glm::length(track.pose(100.05)->position - at.position - 0.05 * glm::dvec3(8, 2, -60)),
        1e-5);
    const FeedPose last = *track.pose(100.11);
    EXPECT_LT(glm::length(last.position - at.position - 0.1 * glm::dvec3(8, 2, -60)), 1e-5);
    for (const double later : {100.2, 101.0, 1e6})
        EXPECT_TRUE(same(*track.pose(later), last)) << later;
    EXPECT_TRUE(same(*track.pose(99), at)); // asked for a time before it
    EXPECT_EQ(track.stream(100.4), Stream::kLive);
    EXPECT_EQ(track.stream(100.6), Stream::kSilent);
    EXPECT_NEAR(track.age_s(103), 3, 1e-9);
}

TEST(PoseTrack, TurnsOnAsTheRatesSay) {
    // A steady turn, banked: only the heading changes, though all three of the aircraft's own axes
    // turn.
    PoseTrack track(flat_earth());
    Said said;
    said.attitude_deg = {30, 5, 350};
    said.rates_deg = {0, 0, 20};
    track.take(packet_of(said), "a", 0);
    const FeedPose later = *track.pose(0.1);
    EXPECT_NEAR(std::remainder(later.yaw_deg - 352, 360), 0, 1e-4);
    EXPECT_NEAR(later.pitch_deg, 5, 1e-4);
    EXPECT_NEAR(later.roll_deg, 30, 1e-4);
    // A loop over the top: 89 degrees up and 40 a second on: 93 is 87 with the heading and the roll
    // turned over.
    said.attitude_deg = {0, 89, 0};
    said.rates_deg = {0, 40, 0};
    PoseTrack loop(flat_earth());
    loop.take(packet_of(said), "a", 0);
    EXPECT_NEAR(loop.pose(0.1)->pitch_deg, 87, 1e-3);
    EXPECT_NEAR(std::abs(loop.pose(0.1)->yaw_deg), 180, 1e-3);
    EXPECT_NEAR(std::abs(loop.pose(0.1)->roll_deg), 180, 1e-3);
    // Rates that no aircraft has turn nothing.
    said.rates_deg = {0, 1e7, 0};
    PoseTrack wild(flat_earth());
    wild.take(packet_of(said), "a", 0);
    EXPECT_NEAR(wild.pose(0.1)->pitch_deg, 89, 1e-3);
}

TEST(PoseTrack, NorthIsWhereItIsOnEarth) {
    PoseTrack track(flat_earth(10));
    Said said = flight_at(0);
    said.attitude_deg.z = 30;
    track.take(packet_of(said), "a", 0);
    EXPECT_NEAR(track.pose(0)->yaw_deg, 40, 1e-4);
    const glm::dvec3 north(std::sin(10 * kDegree), 0, -std::cos(10 * kDegree));
    EXPECT_LT(glm::length(track.pose(0)->velocity_mps - 60.0 * north), 1e-4);
    track.take(packet_of(flight_at(6)), "a", 0.1);
    EXPECT_LT(glm::length(track.pose(0.1)->position - glm::dvec3(0, 300, 0) - 6.0 * north), 1e-4);
}

TEST(PoseTrack, PlacesThatTheFrameDoesNotHoldAreBadPackets) {
    PoseTrack nowhere{scene::PlaceOnEarth()};
    EXPECT_EQ(nowhere.take(packet_of({}), "a", 0), Packet::kRange);
    PoseTrack throws([](double, double) -> glm::dvec2 {
        throw base::Error(base::ExitCode::kBadInput, "no place");
    });
    EXPECT_EQ(throws.take(packet_of({}), "a", 0), Packet::kRange);
    PoseTrack track(flat_earth());
    Said far;
    far.latitude_deg = 70; // 2000 km
    EXPECT_EQ(track.take(packet_of(far), "a", 0), Packet::kRange);
    EXPECT_FALSE(track.pose(0));
}

TEST(PoseTrack, DoubledReplayedAndLatePacketsChangeNothing) {
    for (const std::uint32_t time_step : {0u, 1u, 16'667u}) {
        PoseTrack track(flat_earth());
        for (int i = 0; i < 100; ++i) {
            if (i == 90 || i == 95) // lost for now
                continue;
            ASSERT_EQ(track.take(packet_of(flight_at(i, time_step)), "a", i / 60.0), Packet::kTaken)
                << i;
        }
        const double now = 99 / 60.0 + 0.001;
        const FeedPose before = *track.pose(now);
        EXPECT_EQ(track.take(packet_of(flight_at(99, time_step)), "a", now), Packet::kDoubled);
        EXPECT_EQ(track.take(packet_of(flight_at(98, time_step)), "a", now), Packet::kOld);
        EXPECT_EQ(track.take(packet_of(flight_at(0, time_step)), "a", now), Packet::kOld);
        EXPECT_EQ(track.take(packet_of(flight_at(95, time_step)), "a", now), Packet::kOld);
        EXPECT_EQ(track.take(packet_of(flight_at(90, time_step)), "a", now), Packet::kOld);
        EXPECT_EQ(track.take(packet_of(flight_at(100, time_step)), "b", now), Packet::kForeign);
        EXPECT_TRUE(same(*track.pose(now), before));
        EXPECT_EQ(track.take(packet_of(flight_at(100, time_step)), "a", now), Packet::kTaken);
    }
}

TEST(PoseTrack, TheSendersCountMayRunOver) {
    PoseTrack track(flat_earth());
    Said said = flight_at(0);
    said.time = 0xfffffffe;
    track.take(packet_of(said), "a", 0);
    said = flight_at(1);
    said.time = 3;
    EXPECT_EQ(track.take(packet_of(said), "a", 0.02), Packet::kTaken);
    said = flight_at(2);
    said.time = 0xffffffff;
    EXPECT_EQ(track.take(packet_of(said), "a", 0.04), Packet::kOld);
}

TEST(PoseTrack, AnAircraftMayStandBeMovedAndTurnBack) {
    PoseTrack track(flat_earth());
    track.take(packet_of(flight_at(0)), "a", 0);
    track.take(packet_of(flight_at(1)), "a", 1 / 60.0);
    // A sender that is paused: back to where it says, and the stream stands.
    for (int i = 2; i < 120; ++i)
        EXPECT_EQ(track.take(packet_of(flight_at(1)), "a", i / 60.0), Packet::kDoubled);
    EXPECT_LT(glm::length(track.pose(2)->position - glm::dvec3(0, 300, -1)), 1e-6);
    EXPECT_EQ(track.stream(2), Stream::kPaused);
    EXPECT_EQ(track.take(packet_of(flight_at(2)), "a", 2.01), Packet::kTaken);
    EXPECT_EQ(track.stream(2.01), Stream::kLive);
    EXPECT_GT(track.pose(2.05)->position.z, -4.5);
    EXPECT_LT(track.pose(2.05)->position.z, -2.1);
    // Put elsewhere: at once.
    EXPECT_EQ(track.take(packet_of(flight_at(-5000)), "a", 2.02), Packet::kTaken);
    // Flown backwards: half a second at most, then on.
    int refused = 0;
    track.take(packet_of(flight_at(-4999)), "a", 2.04);
    for (int i = 0; i < 120; ++i)
        refused +=
            track.take(packet_of(flight_at(-5001 - i)), "a", 2.05 + i / 60.0) != Packet::kTaken;
    EXPECT_GT(refused, 0);
    EXPECT_LE(refused, 31);
    EXPECT_LT(glm::length(track.pose(2.05 + 119 / 60.0)->position - glm::dvec3(0, 300, 5120)),
              1e-6);
}

TEST(PoseTrack, ASenderThatRepeatsItsStateIsNotPulledBack) {
    PoseTrack track(flat_earth());
    double before = 1;
    for (int i = 0; i < 80; ++i) { // 60 packets a second of a model that steps 7.5 times
        const double now = i / 60.0;
        EXPECT_EQ(track.take(packet_of(flight_at(i / 8 * 8)), "a", now),
                  i % 8 == 0 ? Packet::kTaken : Packet::kDoubled);
        const double z = track.pose(now)->position.z;
        EXPECT_LE(z, before) << i;
        before = z;
    }
}

TEST(PoseTrack, AfterASilenceAnythingMayBegin) {
    PoseTrack track(flat_earth());
    for (int i = 0; i < 10; ++i)
        track.take(packet_of(flight_at(i, 1000)), "a", i / 60.0);
    EXPECT_EQ(track.take(packet_of(flight_at(0, 1000)), "b", 0.3), Packet::kForeign);
    // The very same flight from the start, by another process.
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(track.take(packet_of(flight_at(i, 1000)), "b", 1 + i / 60.0), Packet::kTaken)
            << i;
    EXPECT_EQ(track.take(packet_of(flight_at(10, 1000)), "a", 1.2), Packet::kForeign);
}

/// One of many ways to be unwelcome.
Bytes hostile_packet(std::mt19937& dice, int newest, std::uint32_t time_step) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto random = [&] { return static_cast<int>(dice() >> 1); };
    Said said = flight_at(newest, time_step);
    said.version = random() % 2 ? 24 : 25;
    switch (random() % 10) {
    case 0: { // short
        Bytes packet = packet_of(said);
        packet.resize(dice() % packet.size());
        return packet;
    }
    case 1: { // long
        Bytes packet = packet_of(said);
        packet.resize(packet.size() + 1 + dice() % 1400, std::byte(random()));
        return packet;
    }
    case 2:
        said.version = dice() % 2 ? 23 : 26;
        break;
    case 3: { // noise
        Bytes packet(random() % 2 ? kFdm24Bytes : kFdm25Bytes);
        for (std::byte& b : packet)
            b = static_cast<std::byte>(random());
        return packet;
    }
    case 4:
        (random() % 2 ? said.latitude_deg : said.altitude_m) = random() % 2 ? nan : 1e300;
        break;
    case 5:
        said.attitude_deg[random() % 3] = random() % 2 ? nan : 1e30;
        break;
    case 6:
        said.velocity_mps[random() % 3] = random() % 2 ? nan : -1e30;
        break;
    case 7:
        said.longitude_deg = 10 + 50 + random() % 100;
        break; // off the frame
    case 8:
        said = flight_at(newest, time_step);
        break; // doubled
    default:
        said = flight_at(newest - random() % 1500, time_step); // replayed
    }
    return packet_of(said);
}

TEST(PoseTrack, TenThousandHostilePacketsChangeNothingButCounters) {
    std::mt19937 random(7);
    for (const std::uint32_t time_step : {0u, 16'667u}) {
        PoseTrack bothered(flat_earth()), alone(flat_earth());
        std::uint64_t hostile = 0;
        for (int i = 0; i < 2000; ++i) {
            const Bytes real = packet_of(flight_at(i, time_step));
            const double now = i / 60.0;
            ASSERT_EQ(bothered.take(real, "a", now), Packet::kTaken);
            ASSERT_EQ(alone.take(real, "a", now), Packet::kTaken);
            for (int j = 0; i >= 1500 && j < 20; ++j, ++hostile) {
                const double then = now + j * 0.0008;
                const bool foreign = random() % 8 == 0;
                ASSERT_NE(bothered.take(foreign ? packet_of(flight_at(i + 1000))
                                                : hostile_packet(random, i, time_step),
                                        foreign ? "b" : "a", then),
                          Packet::kTaken);
                ASSERT_TRUE(same(*bothered.pose(then), *alone.pose(then)));
                ASSERT_EQ(bothered.stream(then), Stream::kLive);
            }
        }
        ASSERT_EQ(hostile, 10'000u);
        std::uint64_t counted = 0;
        for (const std::uint64_t count : bothered.counts())
            counted += count;
        EXPECT_EQ(counted, 12'000u);
        for (std::size_t i = 0; i < static_cast<std::size_t>(Packet::kCount); ++i)
            EXPECT_GT(bothered.counts()[i], 100u) << name_of(static_cast<Packet>(i));
    }
}

TEST(GroundReport, IsThePacketThatIsWrittenDown) {
    GroundReport report;
    report.count = 5;
    report.fed = true;
    report.latitude_deg = 50;
    report.longitude_deg = 10;
    report.fdm_time = 99;
    report.time_s = 12.5;
    report.place = {3, -4};
    report.ground_m = 321.25;
    report.normal = {0.25, 0.5, -0.75};
    report.surface = SurfaceClass::kSparse;
    report.wind_mps = {1.5, 2.5, -3.5};
    Writer w;
    w.u32(0x53574744)
        .u32(1)
        .u32(5)
        .u32(1)
        .f64(12.5)
        .f64(10 * kDegree)
        .f64(50 * kDegree)
        .f64(3)
        .f64(-4)
        .f64(321.25);
    w.f32({0.75, 0.25, -0.5}).f32({3.5, 1.5, -2.5}).u32(2).u32(99);
    const auto packet = encode_report(report);
    EXPECT_EQ(Bytes(packet.begin(), packet.end()), w.bytes);
    report.stands = true;
    EXPECT_EQ(encode_report(report)[15], std::byte(3));
    report.fed = false;
    const auto unfed = encode_report(report);
    EXPECT_EQ(unfed[15], std::byte(2));
    for (const std::size_t i : {24u, 31u, 32u, 39u, 92u, 95u})
        EXPECT_EQ(unfed[i], std::byte(0));
}

} // namespace
} // namespace sward::feed
