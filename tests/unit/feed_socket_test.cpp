// SPDX-License-Identifier: Apache-2.0
// The feed's sockets, on this machine's loopback, and the names of what lies under the aircraft.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "feed/ground_report.h"
#include "feed/pose_track.h"
#include "feed/udp_socket.h"
#include "feed_packets.h"

namespace sward::feed {
namespace {

using namespace tests;

/// What came, waited for as long as it takes.
std::vector<Bytes> receive(UdpReceiver& receiver, std::size_t expected,
                           std::vector<std::string>* senders = nullptr, double* age_s = nullptr) {
    std::vector<Bytes> all;
    for (int i = 0; i < 5000 && all.size() < expected; ++i) {
        receiver.receive([&](const Datagram& datagram) {
            all.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
            if (senders)
                senders->emplace_back(datagram.sender);
            if (age_s)
                *age_s = datagram.age_s;
        });
        if (all.size() < expected)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return all;
}

TEST(FeedEndpoint, IsUdpAndAPortAndPerhapsAHost) {
    const auto is = [](std::string_view text, const std::string& host, int port) {
        const auto endpoint = parse_endpoint(text);
        return endpoint && endpoint->host == host && endpoint->port == port;
    };
    EXPECT_TRUE(is("udp:5550", "", 5550));
    EXPECT_TRUE(is("udp:0", "", 0));
    EXPECT_TRUE(is("udp:127.0.0.1:65535", "127.0.0.1", 65535));
    EXPECT_TRUE(is("udp:sim-host.example:5550", "sim-host.example", 5550));
    EXPECT_TRUE(is("udp:[::1]:5550", "::1", 5550));
    for (const std::string bad :
         {"", "5550", "udp", "udp:", "udp::5550", "udp:65536", "udp:-1", "udp:+1", "udp: 1",
          "udp:1 ", "udp:5550x", "udp:host", "udp:a b:1", "udp:[]:1", "udp:::1:5550", "tcp:5550",
          "UDP:5550", "udp:1e3", "udp:host:"})
        EXPECT_FALSE(parse_endpoint(bad)) << bad;
    EXPECT_FALSE(parse_endpoint("udp:" + std::string(300, 'a') + ":1"));
    EXPECT_FALSE(parse_endpoint(std::string_view("udp:a\0b:1", 9)));
}

TEST(FeedSocket, TakesFromLoopbackWhatIsSentToIt) {
    UdpReceiver receiver({"", 0}, "--native-fdm");
    EXPECT_GT(receiver.port(), 0);
    EXPECT_EQ(receiver.address(), "127.0.0.1:" + std::to_string(receiver.port()));
    UdpSender sender({"localhost", receiver.port()}, "--udp-out"),
        other({"127.0.0.1", receiver.port()}, "--udp-out");
    const Bytes packet = packet_of({}), large(5000, std::byte(1));
    EXPECT_TRUE(sender.send(packet));
    EXPECT_TRUE(sender.send({}));
    EXPECT_TRUE(other.send(large));
    std::vector<std::string> senders;
    const std::vector<Bytes> got = receive(receiver, 3, &senders);
    ASSERT_EQ(got.size(), 3u);
    EXPECT_EQ(got[0], packet);
    EXPECT_TRUE(got[1].empty());
    EXPECT_GT(got[2].size(), kFdm25Bytes); // too long to be anything, by how much does not matter
    EXPECT_EQ(senders[0], senders[1]);
    EXPECT_NE(senders[0], senders[2]);
    EXPECT_EQ(receiver.receive([](const Datagram&) { FAIL(); }), 0);
}

TEST(FeedSocket, KnowsSinceWhenAPacketWaits) {
    UdpReceiver receiver({"", 0}, "--native-fdm");
    UdpSender sender({"", receiver.port()}, "--udp-out");
    double age = 0;
    for (int i = 0; i < 200 && age < 0.03;
         ++i) { // the kernel begins to write times a little after it is asked to
        EXPECT_TRUE(sender.send(packet_of({})));
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        EXPECT_EQ(receive(receiver, 1, nullptr, &age).size(), 1u);
    }
    EXPECT_GE(age, 0.03);
    EXPECT_LE(age, 1);
}

TEST(FeedSocket, HandsOverOnlySoMuchAtOnce) {
    UdpReceiver receiver({"", 0}, "--native-fdm");
    UdpSender sender({"", receiver.port()}, "--udp-out");
    for (int i = 0; i < 20; ++i)
        EXPECT_TRUE(sender.send(packet_of({})));
    int taken = 0;
    const auto count = [&](const Datagram&) { ++taken; };
    EXPECT_EQ(receiver.receive(count, 8), 8);
    EXPECT_EQ(receiver.receive(count, 8), 8);
    EXPECT_EQ(receiver.receive(count, 8), 4);
    EXPECT_EQ(taken, 20);
}

TEST(FeedSocket, APortInUseAndAHostThatIsNoneAreErrorsOfInput) {
    const UdpReceiver first({"", 0}, "--native-fdm");
    const auto complaint = [](auto open) -> std::string {
        try {
            open();
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ExitCode::kIo);
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(
        complaint([&] {
            UdpReceiver second({"", first.port()}, "--native-fdm");
        }),
        "--native-fdm: " + first.address() +
            ": found a port in use, expected an address of this machine and a port that is free");
    EXPECT_NE(complaint([] {
                  UdpReceiver elsewhere({"192.0.2.1", 0}, "--native-fdm");
              }).find("--native-fdm: 192.0.2.1:0: found"),
              std::string::npos);
    EXPECT_NE(complaint([] {
                  UdpSender nobody({"256.1.1.1.invalid", 5}, "--udp-out");
              }).find("256.1.1.1.invalid:5: found"),
              std::string::npos);
}

TEST(FeedSocket, NobodyListeningIsNoError) {
    std::uint16_t port = 0;
    {
        const UdpReceiver gone({"", 0}, "--native-fdm");
        port = gone.port();
    }
    UdpSender sender({"", port}, "--udp-out");
    for (int i = 0; i < 10; ++i)
        EXPECT_TRUE(sender.send(packet_of({})));
}

TEST(GroundReport, NamesWhatLies) {
    using scene::GroundKind;
    const auto of = [](double grass, bool grows = true, GroundKind ground = GroundKind::kSoil) {
        return class_of({true, grass, grows, false, ground});
    };
    EXPECT_EQ(class_of({}), SurfaceClass::kUnknown);
    EXPECT_EQ(of(0), SurfaceClass::kBare);
    EXPECT_EQ(of(0.3), SurfaceClass::kSparse);
    EXPECT_EQ(of(1), SurfaceClass::kGrass);
    EXPECT_EQ(of(0.4, false), SurfaceClass::kBare) << "most of the texel bears none";
    EXPECT_EQ(of(0, false, GroundKind::kRock), SurfaceClass(4));
    EXPECT_EQ(of(0, false, GroundKind::kSand), SurfaceClass(5));
    EXPECT_EQ(of(0, false, GroundKind::kGravel), SurfaceClass(6));
    EXPECT_EQ(of(0, false, GroundKind::kAsphalt), SurfaceClass(7));
    EXPECT_EQ(of(0, false, GroundKind::kWater), SurfaceClass(8));
}

} // namespace
} // namespace sward::feed
