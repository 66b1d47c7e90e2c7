// SPDX-License-Identifier: Apache-2.0
#include "feed/leader.h"

#include <algorithm>

#include "base/hash.h"

namespace sward::feed {
namespace {

constexpr std::size_t kPacketBytes = 1200; // a network carries them whole
constexpr std::uint32_t kWindow = 512;     // frames under way to one that catches up
constexpr int kMostPackets = 64;           // to one follower a picture
constexpr std::uint32_t kRepeated = 4; // frames under way that are few enough to send them again
constexpr double kPatience_s = 0.2;    // then what is under way is taken for lost
constexpr std::size_t kMostInPacket = 48;

} // namespace

Leader::Leader(const LeadStart& start, std::uint64_t session, std::uint64_t secret, Send send,
               std::size_t most_kept)
    : start_(start), session_(session), secret_(secret), send_(std::move(send)),
      most_kept_(most_kept) {}

/// A follower's: whoever says that an address is his must have heard what was sent there.
std::uint64_t Leader::token(std::string_view sender) const {
    const std::string digest = base::sha256_hex(
        std::to_string(secret_) + "/" + std::to_string(session_) + "/" + std::string(sender));
    return std::stoull(digest.substr(0, 16), nullptr, 16);
}

void Leader::welcome(const HelloPacket& hello, std::string_view sender) {
    send_(sender, encode(WelcomePacket{{session_, hello.nonce, token(sender)}, first_, start_}));
}

bool Leader::note(const StatusPacket& status, std::string_view sender, double now_s) {
    if (status.head.session != session_ || status.head.token != token(sender) ||
        status.wants < first_ || status.wants > places())
        return false;
    auto peer = std::find_if(peers_.begin(), peers_.end(),
                             [&](const Peer& p) { return p.sender == sender; });
    if (peer == peers_.end()) {
        if (peers_.size() >= kMostFollowers)
            return false;
        peer = peers_.insert(peers_.end(), Peer{});
        peer->sender = sender;
    }
    if (peer->nonce != status.head.nonce) { // another one at the same address
        *peer = {peer->sender, status.name, status.head.nonce, 0, 0, 0, now_s, now_s};
    }
    peer->heard_s = now_s;
    peer->name = status.name;
    if (status.wants > peer->wants)
        peer->moved_s = now_s;
    peer->wants = std::max(peer->wants, status.wants); // a late word takes nothing back
    peer->sent = std::max(peer->sent, peer->wants);
    if (status.drawn < next_count_)
        peer->drawn = std::max(peer->drawn, status.drawn);
    return true;
}

void Leader::hear(std::span<const std::byte> bytes, std::string_view sender, double now_s) {
    const std::optional<LeadPacket> packet = decode_lead(bytes);
    if (packet && std::holds_alternative<HelloPacket>(*packet))
        return welcome(std::get<HelloPacket>(*packet), sender);
    const StatusPacket* const status = packet ? std::get_if<StatusPacket>(&*packet) : nullptr;
    if (status == nullptr || !note(*status, sender, now_s))
        ++refused_;
}

void Leader::lead(LedFrame frame, double now_s) {
    frame.count = next_count_++;
    frame.place = places();
    begun_s_[frame.count % begun_s_.size()] = now_s;
    std::vector<std::byte> bytes;
    encode_frame(frame, bytes);
    idle_.clear();
    if (frame.idle) {
        idle_ = std::move(bytes);
    } else {
        log_bytes_ += bytes.size();
        log_.push_back(std::move(bytes));
    }
    while (log_bytes_ > most_kept_) {
        log_bytes_ -= log_.front().size();
        log_.pop_front();
        ++first_;
    }
    std::erase_if(peers_, [&](const Peer& peer) {
        return now_s - peer.heard_s > kLost_s || peer.wants < first_;
    });
    for (Peer& peer : peers_)
        send_due(peer, now_s);
}

/// What a follower lacks and what is not under way; and the newest frame at any rate. Few frames
/// under way are sent again with it: one that is lost on the way then costs no time.
void Leader::send_due(Peer& peer, double now_s) {
    if (peer.sent > peer.wants && now_s - peer.moved_s > kPatience_s) {
        peer.sent = peer.wants;
        peer.moved_s = now_s;
    }
    std::uint32_t begin = places() - peer.wants <= kRepeated ? peer.wants : peer.sent;
    const std::uint32_t end = std::min(places(), peer.wants + kWindow);
    int packets = 0;
    do
        begin = send_run(peer, begin, end);
    while (begin < end && ++packets < kMostPackets);
    peer.sent = std::max(peer.sent, begin);
}

/// One packet of the frames from `begin` on, as many as it holds; where they are all, the idle one
/// too. Returns where the next begins.
std::uint32_t Leader::send_run(const Peer& peer, std::uint32_t begin, std::uint32_t end) {
    std::vector<std::byte> frames;
    std::uint32_t count = 0;
    for (; begin < end && count < kMostInPacket; ++begin, ++count) {
        const std::vector<std::byte>& next = log_[begin - first_];
        if (count > 0 && frames.size() + next.size() > kPacketBytes)
            break;
        frames.insert(frames.end(), next.begin(), next.end());
    }
    if (begin == places() && !idle_.empty()) {
        frames.insert(frames.end(), idle_.begin(), idle_.end());
        ++count;
    }
    FramesPacket packet;
    packet.head = {session_, peer.nonce, 0};
    packet.newest = next_count_ - 1;
    packet.places = places();
    send_(peer.sender, encode(packet, count, frames));
    return begin;
}

std::vector<FollowerReport> Leader::reports(double now_s) const {
    std::vector<FollowerReport> reports;
    for (const Peer& peer : peers_) {
        FollowerReport report{peer.name, peer.sender};
        report.frames_behind = next_count_ == 0 ? 0 : next_count_ - 1 - peer.drawn;
        const std::uint32_t next = std::max(
            peer.drawn + 1,
            next_count_ - std::min(next_count_, static_cast<std::uint32_t>(begun_s_.size())));
        if (report.frames_behind > 0)
            report.seconds_behind = now_s - begun_s_[next % begun_s_.size()];
        report.late = report.frames_behind > kLateFrames && report.seconds_behind > kLate_s;
        reports.push_back(std::move(report));
    }
    return reports;
}

} // namespace sward::feed
