// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "feed/follower.h"
#include "feed/leader.h"
#include "feed/udp_socket.h"

namespace sward::app {

/// The number by which two machines know that they have the same scene and program.
[[nodiscard]] std::uint64_t scene_digest(const std::filesystem::path& scene);

/// A master's end of the network. Its port is open as long as it lives.
class LeadLink {
public:
    /// Throws Error(kIo): no such address, port in use.
    explicit LeadLink(const feed::Endpoint& endpoint);
    /// Begins a flight, which followers of the one before begin anew with.
    void begin(const feed::LeadStart& start);
    /// Hears the followers and tells on stderr who comes, is late, keeps up again and goes; then
    /// begins a frame.
    void lead(const feed::LedFrame& frame);
    /// A few words for the line: who follows, and how far behind.
    [[nodiscard]] std::string note() const;

private:
    struct Told {
        std::string sender;
        bool late = false;
    };
    void tell();
    feed::UdpReceiver socket_;
    std::unique_ptr<feed::Leader> leader_;
    std::vector<feed::FollowerReport> reports_;
    std::vector<Told> told_;
};

/// A follower's end.
class FollowLink {
public:
    /// `name`: for the master's people. Throws Error(kIo): no such host.
    FollowLink(const feed::Endpoint& endpoint, const std::string& name);
    /// Hears and says what is due, after waiting so long at most for something to come. Throws
    /// Error(kFailure) where the master no longer keeps what this one lacks.
    void exchange(double wait_s);
    [[nodiscard]] feed::Follower& follower() { return follower_; }
    [[nodiscard]] const std::string& address() const { return socket_.address(); }
    [[nodiscard]] std::string note() const;

private:
    feed::UdpLink socket_;
    feed::Follower follower_;
};

} // namespace sward::app
