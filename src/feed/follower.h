// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feed/lead_packets.h"

namespace sward::feed {

/// Who follows a master: what it has said, in order and each once. No socket and no clock, as
/// Leader.
class Follower {
public:
    /// `nonce` is nobody else's. `name`: for the master's people, printable ASCII.
    Follower(std::uint64_t nonce, std::string name);

    /// Takes a packet of the master's address; what is none of its is counted, and changes nothing
    /// else.
    void hear(std::span<const std::byte> packet, double now_s);
    /// What is due to be said to the master, if anything: a greeting, else how far this one is.
    [[nodiscard]] std::optional<std::vector<std::byte>> word(double now_s);

    /// How the flight began; none before the master has answered.
    [[nodiscard]] const std::optional<LeadStart>& start() const { return start_; }
    /// Whether it can follow no more: the master keeps no more what it lacks.
    [[nodiscard]] bool too_late() const { return too_late_; }
    /// Whether another flight has begun there: this one begins anew with begin_again().
    [[nodiscard]] bool left() const { return left_; }
    void begin_again();
    /// The next frame that changes the field. None: it is not here yet, or there is none.
    [[nodiscard]] std::optional<LedFrame> next();
    /// The newest frame that changes nothing, once all that are before it were taken; once.
    [[nodiscard]] std::optional<LedFrame> idle();
    /// What has been drawn, by its count.
    void drawn(std::uint32_t count);

    [[nodiscard]] std::uint32_t behind() const { return newest_ - std::min(newest_, drawn_); }
    /// Frames that the field lacks.
    [[nodiscard]] std::uint32_t to_do() const { return places_ - std::min(places_, taken_); }
    [[nodiscard]] double silent_s(double now_s) const { return now_s - heard_s_; }
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

private:
    [[nodiscard]] bool take(const WelcomePacket& packet);
    [[nodiscard]] bool take(FramesPacket& packet);

    std::uint64_t nonce_;
    std::string name_;
    std::optional<LeadStart> start_;
    LeadHead head_;
    bool too_late_ = false, left_ = false, news_ = false;
    std::map<std::uint32_t, LedFrame> here_; ///< not yet taken, by place
    std::optional<LedFrame> idle_;
    std::uint32_t taken_ = 0; ///< frames handed out
    std::uint32_t wants_ = 0; ///< the first that is not here
    std::uint32_t places_ = 0, newest_ = 0, drawn_ = 0;
    double heard_s_ = 0, said_s_ = -1e9;
    std::uint64_t refused_ = 0;
};

} // namespace sward::feed
