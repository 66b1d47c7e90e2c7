// SPDX-License-Identifier: Apache-2.0
#include "app/lead_links.h"

#include <algorithm>
#include <chrono>
#include <random>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"

namespace sward::app {
namespace {

constexpr double kQuiet_s = 1; // without a packet, which is worth a word

double clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::uint64_t any_number() {
    std::random_device device;
    return (std::uint64_t{device()} << 32) | device();
}

std::string title(const feed::FollowerReport& report) {
    const std::string address = feed::address_of(report.sender);
    return report.name.empty() ? address : fmt::format("{} ({})", report.name, address);
}

} // namespace

std::uint64_t scene_digest(const std::filesystem::path& scene) {
    constexpr std::uint64_t kLimit = 1 << 24;
    const std::string text =
        scene.extension() == ".toml" ? base::read_text(scene, kLimit) : scene.filename().string();
    return std::stoull(base::sha256_hex(SWARD_VERSION "/" + text).substr(0, 16), nullptr, 16);
}

LeadLink::LeadLink(const feed::Endpoint& endpoint) : socket_(endpoint, "--master") {
    base::log_info("master: listening on udp:" + socket_.address());
}

void LeadLink::begin(const feed::LeadStart& start) {
    leader_ = std::make_unique<feed::Leader>(
        start, any_number(), any_number(),
        [this](std::string_view to, std::span<const std::byte> packet) {
            socket_.answer(to, packet); // a lost one is sent again
        });
}

void LeadLink::lead(const feed::LedFrame& frame) {
    const double now = clock_s();
    socket_.receive([&](const feed::Datagram& datagram) {
        leader_->hear(datagram.bytes, datagram.sender, now);
    });
    leader_->lead(frame, now);
    reports_ = leader_->reports(now);
    tell();
}

void LeadLink::tell() {
    const auto is_of = [](const feed::FollowerReport& report) {
        return [&](const Told& told) { return told.sender == report.sender; };
    };
    for (const feed::FollowerReport& report : reports_) {
        auto told = std::ranges::find_if(told_, is_of(report));
        if (told == told_.end()) {
            base::log_info("master: " + title(report) + " follows");
            told = told_.insert(told_.end(), {report.sender, true}); // it has a way to go
        }
        if (report.late && !told->late)
            base::log_warning(fmt::format("master: {} is late: {} frames, {:.2f} s", title(report),
                                          report.frames_behind, report.seconds_behind));
        else if (!report.late && told->late)
            base::log_info("master: " + title(report) + " keeps up");
        told->late = report.late;
    }
    std::erase_if(told_, [&](const Told& told) {
        const bool gone = std::ranges::none_of(
            reports_, [&](const auto& report) { return report.sender == told.sender; });
        if (gone)
            base::log_warning("master: " + feed::address_of(told.sender) + " is gone");
        return gone;
    });
}

std::string LeadLink::note() const {
    if (leader_ == nullptr)
        return {};
    std::string text = fmt::format("frame {}, leads {}", leader_->frames(), reports_.size());
    for (const feed::FollowerReport& report : reports_)
        if (report.late)
            text += fmt::format(", {} late by {} frames", title(report), report.frames_behind);
    if (leader_->refused() > 0)
        text += fmt::format(", {} refused", leader_->refused());
    return text;
}

FollowLink::FollowLink(const feed::Endpoint& endpoint, const std::string& name)
    : socket_(endpoint, "--follow"), follower_(any_number(), name) {}

void FollowLink::exchange(double wait_s) {
    if (wait_s > 0)
        socket_.wait(wait_s);
    const double now = clock_s();
    socket_.receive([&](const feed::Datagram& datagram) { follower_.hear(datagram.bytes, now); });
    if (follower_.too_late())
        throw base::Error(base::ExitCode::kFailure,
                          fmt::format("--follow: {}: found a flight whose beginning is no longer "
                                      "kept, expected to come earlier, or a master that began anew",
                                      address()));
    if (const auto word = follower_.word(now))
        socket_.send(*word);
}

std::string FollowLink::note() const {
    std::string text = "follows " + address();
    if (const std::uint32_t left = follower_.to_do(); left > 60)
        text += fmt::format(", {} frames to catch up", left);
    else if (follower_.behind() > feed::kLateFrames)
        text += fmt::format(", {} frames late", follower_.behind());
    if (const double silent = follower_.silent_s(clock_s()); silent > kQuiet_s)
        text += fmt::format(", which is silent since {:.0f} s", silent);
    if (follower_.refused() > 0)
        text += fmt::format(", {} packets refused", follower_.refused());
    return text;
}

} // namespace sward::app
