// SPDX-License-Identifier: Apache-2.0
#include "feed/follower.h"

#include <algorithm>
#include <utility>

namespace sward::feed {
namespace {

constexpr double kGreet_s = 0.25;          // between greetings
constexpr double kSay_s = 0.05;            // between words that say nothing new
constexpr double kQuiet_s = 2;             // then it is asked whether the master has begun anew
constexpr std::uint32_t kMostHere = 16384; // frames that wait

} // namespace

Follower::Follower(std::uint64_t nonce, std::string name) : nonce_(nonce), name_(std::move(name)) {
    name_.resize(std::min(name_.size(), kMostName));
}

void Follower::begin_again() {
    const std::uint64_t refused = refused_;
    *this = Follower(nonce_ + 1, name_);
    refused_ = refused;
}

bool Follower::take(const WelcomePacket& packet) {
    if (packet.head.nonce != nonce_)
        return false;
    too_late_ = packet.first > wants_ && (!start_ || packet.head.session == head_.session);
    if (start_) { // the same again, or another flight
        left_ = left_ || packet.head.session != head_.session;
        return true;
    }
    head_ = packet.head;
    start_ = packet.start;
    return true;
}

bool Follower::take(FramesPacket& packet) {
    if (!start_ || packet.head.session != head_.session || packet.head.nonce != nonce_)
        return false;
    newest_ = std::max(newest_, packet.newest);
    places_ = std::max(places_, packet.places);
    for (LedFrame& frame : packet.frames) {
        if (frame.idle) {
            if (!idle_ || frame.count > idle_->count)
                idle_ = std::move(frame);
        } else if (frame.place >= wants_ && frame.place < taken_ + kMostHere) {
            here_.try_emplace(frame.place, std::move(frame));
        }
    }
    while (here_.contains(wants_))
        ++wants_;
    news_ = true;
    return true;
}

void Follower::hear(std::span<const std::byte> bytes, double now_s) {
    std::optional<LeadPacket> packet = decode_lead(bytes);
    bool taken = false;
    if (packet && std::holds_alternative<WelcomePacket>(*packet))
        taken = take(std::get<WelcomePacket>(*packet));
    else if (packet && std::holds_alternative<FramesPacket>(*packet))
        taken = take(std::get<FramesPacket>(*packet));
    if (taken)
        heard_s_ = now_s;
    else
        ++refused_;
}

std::optional<std::vector<std::byte>> Follower::word(double now_s) {
    const bool greets = !start_ || silent_s(now_s) > kQuiet_s;
    const double every_s = greets ? kGreet_s : news_ ? 0 : kSay_s;
    if (now_s - said_s_ < every_s)
        return std::nullopt;
    said_s_ = now_s;
    news_ = false;
    if (greets)
        return encode(HelloPacket{nonce_});
    return encode(StatusPacket{head_, wants_, drawn_, name_});
}

std::optional<LedFrame> Follower::next() {
    const auto found = here_.find(taken_);
    if (found == here_.end())
        return std::nullopt;
    LedFrame frame = std::move(found->second);
    here_.erase(found);
    ++taken_;
    return frame;
}

std::optional<LedFrame> Follower::idle() {
    if (!idle_ || idle_->place > taken_)
        return std::nullopt;
    std::optional<LedFrame> frame = std::exchange(idle_, std::nullopt);
    if (frame->place < taken_) // what has been done since has led on
        return std::nullopt;
    return frame;
}

void Follower::drawn(std::uint32_t count) {
    drawn_ = std::max(drawn_, count);
    news_ = true;
}

} // namespace sward::feed
