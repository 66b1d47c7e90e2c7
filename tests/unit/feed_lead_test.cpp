// SPDX-License-Identifier: Apache-2.0
// Master and followers over a network that loses, doubles and turns round what it carries; and
// what strangers send.
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "feed/follower.h"
#include "feed/leader.h"

namespace {

using namespace sward::feed;
using sward::Ball;
using sward::Blower;
using sward::MeanWind;
using sward::Sun;
using Bytes = std::vector<std::byte>;

LedFrame frame_of(int number) {
    LedFrame frame;
    frame.time_s = number / 60.0;
    frame.hour = 9.5;
    frame.position = {std::sin(number) * 1e3, 2, -number};
    frame.yaw_deg = number * 0.7;
    frame.roll_deg = -3;
    frame.first_step = static_cast<std::uint32_t>(number);
    frame.eyes = {frame.position};
    return frame;
}

LedFrame full_frame() {
    LedFrame frame = frame_of(5);
    frame.changes = {{5, Sun{123.25, 7.0 / 3}}, {6, MeanWind{9, 45, 0.1}}};
    frame.balls = {{{1, 2, 3}, 0.25}, {{4, 5, 6}, 1}};
    sward::Body body;
    body.object = 3;
    body.world_from_body[0] = {0, 0, -1, 0};
    body.world_from_body[3] = {100.5, 20, -7.125, 1};
    frame.bodies = {body};
    frame.blows = true;
    frame.blowers = {{Blower::Kind::kRotor, {1, 2}, {3, 4}, 90, 14, 5, 6, 1},
                     {Blower::Kind::kJet, {}, {}}};
    return frame;
}

bool same(const LedFrame& a, const LedFrame& b) {
    Bytes one, two;
    encode_frame(a, one);
    encode_frame(b, two);
    return one == two;
}

LeadStart flight() {
    LeadStart start;
    start.start_s = 2.5;
    start.density = 0.75;
    start.seed = -7;
    start.scene = 0x1234567890abcdef;
    start.wind = {6, 200, 0.3};
    return start;
}

/// A master and those that follow it, over a network that loses a share of the packets.
struct Net {
    explicit Net(double loss, std::size_t most_kept = Leader::kMostKept)
        : leader(
              flight(), 77, 99,
              [this](std::string_view to, std::span<const std::byte> packet) {
                  carry({std::string(to), {packet.begin(), packet.end()}});
              },
              most_kept),
          loss_(loss) {}

    struct Seat {
        std::string address;
        std::unique_ptr<Follower> follower;
        std::vector<LedFrame> got;
        std::vector<LedFrame> idle;
        bool stands = false; ///< hears and says nothing
    };

    Seat& join(std::string address) {
        const auto nonce = 1000 + seats.size();
        seats.push_back(
            Seat{std::move(address), std::make_unique<Follower>(nonce, "left"), {}, {}, false});
        return seats.back();
    }
    void step() {
        now_s += 1.0 / 60;
        for (Seat& seat : seats)
            if (const auto word = seat.stands ? std::nullopt : seat.follower->word(now_s);
                word && !lost())
                leader.hear(*word, seat.address, now_s);
        std::deque<std::pair<std::string, Bytes>> due;
        due.swap(under_way_);
        for (const auto& [to, packet] : due)
            for (Seat& seat : seats)
                if (seat.address == to && !seat.stands)
                    seat.follower->hear(packet, now_s);
        for (Seat& seat : seats) {
            while (auto next = seat.follower->next())
                seat.got.push_back(*next);
            if (auto idle = seat.follower->idle())
                seat.idle.push_back(*idle);
            if (!seat.got.empty())
                seat.follower->drawn(seat.got.back().count);
        }
    }
    void carry(std::pair<std::string, Bytes> packet) {
        if (lost())
            return;
        const std::size_t at = under_way_.empty() ? 0 : random_() % (under_way_.size() + 1);
        if (random_() % 10 == 0)
            under_way_.push_back(packet); // twice
        under_way_.insert(under_way_.begin() + static_cast<std::ptrdiff_t>(at), std::move(packet));
    }
    bool lost() { return std::uniform_real_distribution<double>(0, 1)(random_) < loss_; }

    double now_s = 100;
    Leader leader;
    std::vector<Seat> seats;

private:
    double loss_;
    std::mt19937 random_{5};
    std::deque<std::pair<std::string, Bytes>> under_way_;
};

TEST(Lead, AFrameComesBackBitForBit) {
    for (const LedFrame& frame : {frame_of(3), full_frame(), LedFrame{}}) {
        Bytes bytes(7); // it need not begin at the first byte
        encode_frame(frame, bytes);
        std::size_t at = 7;
        const auto back = decode_frame(bytes, at);
        ASSERT_TRUE(back);
        EXPECT_EQ(at, bytes.size());
        EXPECT_TRUE(same(*back, frame));
    }
    std::size_t at = 0;
    Bytes bytes;
    encode_frame(full_frame(), bytes);
    const LedFrame back = decode_frame(bytes, at).value();
    EXPECT_EQ(back.position, full_frame().position);
    EXPECT_EQ(std::get<Sun>(back.changes[0].what).elevation_deg, 7.0 / 3);
    EXPECT_EQ(back.bodies[0].world_from_body, full_frame().bodies[0].world_from_body);
    EXPECT_EQ(back.blowers.at(0).speed_mps, 14);
}

TEST(Lead, EveryFollowerHasEveryFrameInOrderWhateverTheNetworkLoses) {
    for (const double loss : {0.0, 0.3}) {
        Net net(loss);
        net.seats.reserve(3);
        net.join("a");
        net.join("b");
        for (int i = 0; i < 1200; ++i) {
            if (i == 900)
                net.join("late");
            net.leader.lead(i % 100 == 50 ? full_frame() : frame_of(i), net.now_s);
            net.step();
        }
        LedFrame idle = frame_of(0);
        idle.idle = true;
        for (int i = 0; i < 400; ++i) { // time stands
            net.leader.lead(idle, net.now_s);
            net.step();
        }
        for (const Net::Seat& seat : net.seats) {
            ASSERT_EQ(seat.follower->start(), flight()) << loss;
            ASSERT_EQ(seat.got.size(), 1200u) << seat.address << " " << loss;
            for (std::size_t i = 0; i < seat.got.size(); ++i) {
                LedFrame wanted = i % 100 == 50 ? full_frame() : frame_of(static_cast<int>(i));
                wanted.count = wanted.place = static_cast<std::uint32_t>(i);
                ASSERT_TRUE(same(seat.got[i], wanted)) << i;
            }
            ASSERT_FALSE(seat.idle.empty());
            EXPECT_GT(seat.idle.back().count, 1580u);
            EXPECT_EQ(seat.follower->to_do(), 0u);
            EXPECT_EQ(seat.follower->refused(), 0u);
        }
        EXPECT_EQ(net.leader.refused(), 0u);
    }
}

TEST(Lead, WhoIsLateIsSaid) {
    Net net(0);
    net.seats.reserve(2);
    net.join("quick");
    net.join("slow");
    for (int i = 0; i < 120; ++i) {
        net.seats[1].stands = i >= 60;
        net.leader.lead(frame_of(i), net.now_s);
        net.step();
    }
    const auto reports = net.leader.reports(net.now_s);
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0].name, "left");
    EXPECT_FALSE(reports[0].late) << reports[0].frames_behind;
    EXPECT_LE(reports[0].frames_behind, kLateFrames);
    EXPECT_EQ(reports[1].sender, "slow");
    EXPECT_TRUE(reports[1].late);
    EXPECT_NEAR(reports[1].frames_behind, 60, 3);
    EXPECT_NEAR(reports[1].seconds_behind, 1, 0.1);
    for (int i = 0; i < 300; ++i)
        net.leader.lead(frame_of(i), net.now_s += 1.0 / 60);
    EXPECT_TRUE(net.leader.reports(net.now_s).empty()) << "silent, so gone";
}

TEST(Lead, ABeginningThatIsNoLongerKeptIsSaid) {
    Net net(0, 20'000);
    net.seats.reserve(2);
    net.join("first");
    for (int i = 0; i < 600; ++i) {
        net.leader.lead(frame_of(i), net.now_s);
        net.step();
        if (i == 500)
            net.join("late");
    }
    EXPECT_EQ(net.seats[0].got.size(), 600u);
    EXPECT_FALSE(net.seats[0].follower->too_late());
    EXPECT_TRUE(net.seats[1].follower->too_late());
    EXPECT_TRUE(net.seats[1].got.empty());
}

TEST(Lead, AnotherFlightIsNoticedAndBegunAnew) {
    Follower follower(5, "");
    const auto welcome = [](std::uint64_t session, std::uint64_t nonce) {
        return encode(WelcomePacket{{session, nonce, 1}, 0, flight()});
    };
    follower.hear(welcome(1, 6), 0);
    EXPECT_FALSE(follower.start()) << "an answer to somebody else";
    follower.hear(welcome(1, 5), 0);
    EXPECT_TRUE(follower.start());
    follower.hear(welcome(1, 5), 1);
    EXPECT_FALSE(follower.left());
    ASSERT_TRUE(follower.word(10));
    follower.hear(welcome(2, 5), 10);
    EXPECT_TRUE(follower.left());
    follower.begin_again();
    EXPECT_FALSE(follower.left() || follower.start());
    EXPECT_EQ(follower.refused(), 1u);
}

TEST(Lead, HostilePacketsChangeNothingButACounter) {
    Net net(0);
    net.seats.reserve(1);
    Net::Seat& seat = net.join("a");
    for (int i = 0; i < 30; ++i) {
        net.leader.lead(frame_of(i), net.now_s);
        net.step();
    }
    std::vector<Bytes> good = {
        encode(StatusPacket{{77, 1000, 0}, 3, 3, "x"}), // a token that is none
        encode(StatusPacket{{78, 1000, 1}, 3, 3, ""}),  // another flight
        encode(WelcomePacket{{77, 4, 1}, 0, flight()}), // another's
        encode(FramesPacket{{77, 4, 0}, 1u << 30, 9, {}}, 0, {}),
        encode(FramesPacket{{76, 1000, 0}, 1u << 30, 9, {}}, 0, {}),
        encode(FramesPacket{{77, 1000, 0}, 5, 5, {}}, 3, {}), // of frames that are not there
    };
    for (const double bad : {std::nan(""), 1e300, -std::numeric_limits<double>::infinity()}) {
        LedFrame frame = full_frame();
        frame.position.y = bad;
        Bytes bytes;
        encode_frame(frame, bytes);
        good.push_back(encode(FramesPacket{{77, 1000, 0}, 40, 40, {}}, 1, bytes));
    }
    std::mt19937 random(3);
    std::uint64_t sent = 0;
    const std::uint64_t before = net.leader.refused();
    for (int i = 0; i < 10'000; ++i) {
        Bytes packet = good[static_cast<std::size_t>(i) % good.size()];
        if (i >= static_cast<int>(good.size())) {
            if (random() % 3 == 0)
                packet.resize(random() % 2000);
            for (int k = static_cast<int>(random() % 4); k >= 0 && !packet.empty(); --k)
                packet[random() % std::min<std::size_t>(packet.size(), 36)] ^=
                    std::byte{static_cast<unsigned char>(1 + random() % 255)};
        }
        net.leader.hear(packet, "stranger", net.now_s);
        seat.follower->hear(packet, net.now_s);
        ++sent;
    }
    EXPECT_EQ(net.leader.refused() - before, sent);
    EXPECT_EQ(seat.follower->refused(), sent);
    EXPECT_FALSE(seat.follower->left());
    EXPECT_EQ(net.leader.reports(net.now_s).size(), 1u);
    EXPECT_FALSE(seat.follower->next());
    for (int i = 30; i < 60; ++i) {
        net.leader.lead(frame_of(i), net.now_s);
        net.step();
    }
    EXPECT_GE(seat.got.size(), 58u);
}

TEST(Lead, AnAnswerToAGreetingIsNotLongerThanIt) {
    EXPECT_LE(encode(WelcomePacket{{1, 2, 3}, 0, flight()}).size(), encode(HelloPacket{4}).size());
}

} // namespace
