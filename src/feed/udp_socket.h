// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sward::feed {

/// Where packets come in or go to, as an option writes it.
struct Endpoint {
    std::string host; ///< a name or an address; empty: this machine alone, by 127.0.0.1
    std::uint16_t port = 0;
};
/// "udp:PORT" or "udp:HOST:PORT", HOST a name, an IPv4 address or an IPv6 one in brackets, PORT 0
/// to 65535. None for anything else.
[[nodiscard]] std::optional<Endpoint> parse_endpoint(std::string_view text);

struct Datagram {
    std::span<const std::byte> bytes;
    std::string_view sender; ///< its address and port, in the system's form
    double age_s = 0;        ///< since the machine got it; 0 to 1
};

/// A bound socket that nobody waits on. Not shared with another program.
class UdpReceiver {
public:
    /// Binds. Port 0: one that is free. Throws Error(kIo) that names `option`: no such address,
    /// port in use.
    UdpReceiver(const Endpoint& endpoint, std::string_view option);
    ~UdpReceiver();
    UdpReceiver(const UdpReceiver&) = delete;
    UdpReceiver& operator=(const UdpReceiver&) = delete;

    [[nodiscard]] const std::string& address() const { return address_; } ///< "127.0.0.1:5550"
    [[nodiscard]] std::uint16_t port() const { return port_; }
    /// Hands over what has come since the last call, in order, `most` packets at most: a flood
    /// shall not stop the picture. Returns how many.
    int receive(const std::function<void(const Datagram&)>& take, int most = 1024);
    /// Sends to whom a packet came from. Never waits; false where the system would not take it.
    bool answer(std::string_view sender, std::span<const std::byte> bytes);

private:
    int handle_ = -1;
    std::uint16_t port_ = 0;
    std::string address_;
};

/// "127.0.0.1:5550" of a Datagram's sender.
[[nodiscard]] std::string address_of(std::string_view sender);

/// A socket for sending to one place. Nobody else can reach it, and nothing that comes back is
/// read.
class UdpSender {
public:
    /// Throws Error(kIo) that names `option`: no such host, no way to it.
    UdpSender(const Endpoint& endpoint, std::string_view option);
    ~UdpSender();
    UdpSender(const UdpSender&) = delete;
    UdpSender& operator=(const UdpSender&) = delete;

    /// Never waits. False where the system would not take it; nobody listening is no error.
    bool send(std::span<const std::byte> bytes);
    [[nodiscard]] const std::string& address() const { return address_; }

private:
    int handle_ = -1;
    std::string address_;
};

/// A socket between this program and one other. Nobody else can reach it.
class UdpLink {
public:
    /// Throws Error(kIo) that names `option`: no such host, no way to it.
    UdpLink(const Endpoint& endpoint, std::string_view option);
    ~UdpLink();
    UdpLink(const UdpLink&) = delete;
    UdpLink& operator=(const UdpLink&) = delete;

    /// As UdpSender's.
    bool send(std::span<const std::byte> bytes);
    /// As UdpReceiver's.
    int receive(const std::function<void(const Datagram&)>& take, int most = 4096);
    /// Sleeps until something comes, so many seconds at most.
    void wait(double seconds) const;
    [[nodiscard]] const std::string& address() const { return address_; } ///< the other's

private:
    int handle_ = -1;
    std::string address_;
};

} // namespace sward::feed
