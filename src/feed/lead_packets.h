// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feed/led_frame.h"

namespace sward::feed {

// What master and followers say to each other: docs/simulator-integration.md has the bytes.
inline constexpr std::uint32_t kLeadVersion = 1;
inline constexpr std::size_t kMostName = 32; ///< bytes of a follower's name

/// How a master's flight began: a follower begins its field likewise.
struct LeadStart {
    double start_s = 0; ///< simulated time of step 0
    double density = 1; ///< of the scene's grass
    std::int32_t seed = 0;
    std::uint64_t scene =
        0; ///< digest of the scene and the program; another one may look otherwise
    Sun sun;
    MeanWind wind;
    bool operator==(const LeadStart& o) const {
        return start_s == o.start_s && density == o.density && seed == o.seed && scene == o.scene;
    }
};

/// Whom a packet is of. A nonce is the follower's choice, a token the master's for its address: who
/// cannot hear the other does not know them.
struct LeadHead {
    std::uint64_t session = 0, nonce = 0, token = 0;
};

/// A follower asks to be led.
struct HelloPacket {
    std::uint64_t nonce = 0;
};

/// The answer.
struct WelcomePacket {
    LeadHead head;
    std::uint32_t first = 0; ///< place of the first frame that is kept
    LeadStart start;
};

/// What a follower has.
struct StatusPacket {
    LeadHead head;
    std::uint32_t wants = 0; ///< the first frame that it lacks, by its place
    std::uint32_t drawn = 0; ///< the last that it has drawn, by its count
    std::string name;        ///< its own, printable ASCII
};

/// What the master does.
struct FramesPacket {
    LeadHead head;
    std::uint32_t newest = 0; ///< count
    std::uint32_t places = 0; ///< frames that change the field, so far
    std::vector<LedFrame> frames;
};

[[nodiscard]] std::vector<std::byte> encode(const HelloPacket& packet);
[[nodiscard]] std::vector<std::byte> encode(const WelcomePacket& packet);
[[nodiscard]] std::vector<std::byte> encode(const StatusPacket& packet);
/// Of frames that are encoded already, one after another.
[[nodiscard]] std::vector<std::byte> encode(const FramesPacket& packet, std::uint32_t count,
                                            std::span<const std::byte> frames);

using LeadPacket = std::variant<HelloPacket, WelcomePacket, StatusPacket, FramesPacket>;
/// None for anything that is no such packet from its first byte to its last.
[[nodiscard]] std::optional<LeadPacket> decode_lead(std::span<const std::byte> bytes);

} // namespace sward::feed
