// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feed/lead_packets.h"

namespace sward::feed {

inline constexpr double kLate_s = 0.1;          ///< after a frame begun that is not drawn yet
inline constexpr std::uint32_t kLateFrames = 2; ///< and so many frames
inline constexpr double kLost_s = 3;            ///< of silence, after which a follower is gone

/// How far one follower is.
struct FollowerReport {
    std::string name;   ///< its own word for itself; may be empty
    std::string sender; ///< its address, in the system's form
    std::uint32_t frames_behind = 0;
    double seconds_behind = 0; ///< since the frame began that it draws next
    bool late = false;
};

/// A master: numbers frames, keeps them from the flight's beginning for those that come late, sends
/// each follower what it lacks. No socket and no clock: times are seconds of one that never goes
/// back.
class Leader {
public:
    using Send = std::function<void(std::string_view to, std::span<const std::byte> packet)>;
    static constexpr std::size_t kMostFollowers = 32;
    static constexpr std::size_t kMostKept = std::size_t{512} << 20; ///< bytes of frames

    /// `session` and `secret` are nobody else's. `most_kept`: bytes; past them no more is kept, and
    /// who comes later is told so.
    Leader(const LeadStart& start, std::uint64_t session, std::uint64_t secret, Send send,
           std::size_t most_kept = kMostKept);

    /// Takes a packet; what is none of a follower's is counted, and changes nothing else.
    void hear(std::span<const std::byte> packet, std::string_view sender, double now_s);
    /// Begins a frame: numbers it and sends it. One that is idle is not kept.
    void lead(LedFrame frame, double now_s);

    [[nodiscard]] std::vector<FollowerReport> reports(double now_s) const;
    [[nodiscard]] std::uint64_t refused() const { return refused_; }
    [[nodiscard]] std::uint32_t frames() const { return next_count_; }

private:
    struct Peer {
        std::string sender, name;
        std::uint64_t nonce = 0;
        std::uint32_t wants = 0, sent = 0, drawn = 0;
        double heard_s = 0;
        double moved_s = 0; ///< when what it wants last went on, or was sent anew
    };
    [[nodiscard]] std::uint64_t token(std::string_view sender) const;
    void welcome(const HelloPacket& hello, std::string_view sender);
    bool note(const StatusPacket& status, std::string_view sender, double now_s);
    void send_due(Peer& peer, double now_s);
    std::uint32_t send_run(const Peer& peer, std::uint32_t begin, std::uint32_t end);
    [[nodiscard]] std::uint32_t places() const {
        return first_ + static_cast<std::uint32_t>(log_.size());
    }

    LeadStart start_;
    std::uint64_t session_, secret_;
    Send send_;
    std::size_t most_kept_;
    std::deque<std::vector<std::byte>> log_; ///< frames that change the field, encoded
    std::size_t log_bytes_ = 0;
    std::uint32_t first_ = 0;     ///< place of the first of them: 0 while all are kept
    std::vector<std::byte> idle_; ///< the newest frame, where it changes nothing
    std::uint32_t next_count_ = 0;
    std::array<double, 1024> begun_s_{}; ///< of the last frames, by their count
    std::vector<Peer> peers_;
    std::uint64_t refused_ = 0;
};

} // namespace sward::feed
