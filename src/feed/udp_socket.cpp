// SPDX-License-Identifier: Apache-2.0
#include "feed/udp_socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <memory>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/error.h"

namespace sward::feed {
namespace {

constexpr std::size_t kMostHost = 253; // bytes: a name of the DNS
constexpr std::size_t kMostPacket =
    12'288; // more than any packet that is known; what is longer shows by its size

struct FreeAddresses {
    void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

base::Error failure(std::string_view option, const std::string& where, const std::string& found,
                    std::string_view expected) {
    return {base::ExitCode::kIo, fmt::format("{}: {}: found {}, expected {}", option,
                                             base::printable(where, 300), found, expected)};
}

std::string reason(int code) {
    return std::generic_category().message(code);
}

std::string written(const Endpoint& endpoint) {
    const std::string host = endpoint.host.empty() ? "127.0.0.1" : endpoint.host;
    return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, endpoint.port)
                                               : fmt::format("[{}]:{}", host, endpoint.port);
}

Addresses look_up(const Endpoint& endpoint, std::string_view option) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICSERV;
    addrinfo* list = nullptr;
    const std::string host = endpoint.host.empty() ? "127.0.0.1" : endpoint.host;
    const int code =
        getaddrinfo(host.c_str(), fmt::format("{}", endpoint.port).c_str(), &hints, &list);
    if (code != 0)
        throw failure(option, written(endpoint), gai_strerror(code),
                      "a host that this machine knows");
    return Addresses(list);
}

/// A socket on the first of the addresses that `join` takes (bind or connect).
int open_socket(const Endpoint& endpoint, std::string_view option,
                int (*join)(int, const sockaddr*, socklen_t), const char* expected) {
    const Addresses addresses = look_up(endpoint, option);
    int code = 0;
    for (const addrinfo* at = addresses.get(); at; at = at->ai_next) {
        const int handle = socket(at->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (handle >= 0 && join(handle, at->ai_addr, at->ai_addrlen) == 0)
            return handle;
        code = errno;
        if (handle >= 0)
            close(handle);
    }
    throw failure(option, written(endpoint), code == EADDRINUSE ? "a port in use" : reason(code),
                  expected);
}

/// "127.0.0.1:5550" of a socket's own end or of the other, and the port.
std::pair<std::string, std::uint16_t> name_of(const sockaddr_storage& address, socklen_t size) {
    std::array<char, 64> host{}, port{};
    if (getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(),
                    port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return {"?", 0};
    std::uint16_t number = 0;
    std::from_chars(port.data(), port.data() + std::strlen(port.data()), number);
    return {written({host.data(), number}), number};
}

/// How long ago the kernel got a packet, by the time it wrote beside it: a picture may take longer
/// than packets are apart.
double age_of(msghdr& message) {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    for (cmsghdr* at = CMSG_FIRSTHDR(&message); at; at = CMSG_NXTHDR(&message, at)) {
        if (at->cmsg_level != SOL_SOCKET || at->cmsg_type != SCM_TIMESTAMPNS)
            continue;
        timespec then{};
        std::memcpy(&then, CMSG_DATA(at), sizeof then);
        const double age =
            double(now.tv_sec - then.tv_sec) + 1e-9 * double(now.tv_nsec - then.tv_nsec);
        return std::clamp(age, 0.0, 1.0); // the machine's clock may be set meanwhile
    }
    return 0;
}

/// Hands over what has come.
int receive_from(int handle, const std::function<void(const Datagram&)>& take, int most) {
    std::array<std::byte, kMostPacket> bytes;
    alignas(cmsghdr) std::array<std::byte, 128> control;
    for (int count = 0; count < most; ++count) {
        sockaddr_storage from{};
        iovec part{bytes.data(), bytes.size()};
        msghdr message{};
        message.msg_name = &from;
        message.msg_namelen = sizeof from;
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        const ssize_t size = recvmsg(handle, &message, 0);
        if (size < 0 && (errno == EINTR || errno == ECONNREFUSED)) // nobody was there, once
            continue;
        if (size < 0) // nothing more; or a network that is gone, which is silence too
            return count;
        const std::string_view sender(reinterpret_cast<const char*>(&from), message.msg_namelen);
        take({std::span(bytes.data(), static_cast<std::size_t>(size)), sender, age_of(message)});
    }
    return most;
}

/// Never waits.
bool send_to(int handle, std::span<const std::byte> bytes) {
    // What nobody listened to comes back as ECONNREFUSED of the next one, which has not gone out
    // then.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (::send(handle, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
            static_cast<ssize_t>(bytes.size()))
            return true;
        if (errno != ECONNREFUSED && errno != EINTR)
            return false;
    }
    return false;
}

} // namespace

std::optional<Endpoint> parse_endpoint(std::string_view text) {
    constexpr std::string_view kScheme = "udp:";
    if (!text.starts_with(kScheme))
        return std::nullopt;
    text.remove_prefix(kScheme.size());
    Endpoint endpoint;
    if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
        std::string_view host = text.substr(0, colon);
        const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
        if (bracketed)
            host = host.substr(1, host.size() - 2);
        const auto fits = [&](char c) {
            return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                   c == '.' || c == '-' || c == '_' || (bracketed && (c == ':' || c == '%'));
        };
        if (host.empty() || host.size() > kMostHost || !std::all_of(host.begin(), host.end(), fits))
            return std::nullopt;
        endpoint.host = host;
        text.remove_prefix(colon + 1);
    }
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), endpoint.port);
    if (error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return endpoint;
}

UdpReceiver::UdpReceiver(const Endpoint& endpoint, std::string_view option)
    : handle_(open_socket(endpoint, option, bind,
                          "an address of this machine and a port that is free")) {
    const int on = 1;
    setsockopt(handle_, SOL_SOCKET, SO_TIMESTAMPNS, &on,
               sizeof on); // without it packets count from when they are read
    sockaddr_storage own{};
    socklen_t size = sizeof own;
    getsockname(handle_, reinterpret_cast<sockaddr*>(&own), &size);
    std::tie(address_, port_) = name_of(own, size);
}

UdpReceiver::~UdpReceiver() {
    close(handle_);
}

int UdpReceiver::receive(const std::function<void(const Datagram&)>& take, int most) {
    return receive_from(handle_, take, most);
}

bool UdpReceiver::answer(std::string_view sender, std::span<const std::byte> bytes) {
    sockaddr_storage to{};
    if (sender.size() > sizeof to)
        return false;
    std::memcpy(&to, sender.data(), sender.size());
    return sendto(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&to),
                  static_cast<socklen_t>(sender.size())) == static_cast<ssize_t>(bytes.size());
}

std::string address_of(std::string_view sender) {
    sockaddr_storage address{};
    std::memcpy(&address, sender.data(), std::min(sender.size(), sizeof address));
    return name_of(address, static_cast<socklen_t>(sender.size())).first;
}

UdpSender::UdpSender(const Endpoint& endpoint, std::string_view option)
    : handle_(open_socket(endpoint, option, connect, "a host that can be reached")) {
    shutdown(handle_, SHUT_RD);
    sockaddr_storage other{};
    socklen_t size = sizeof other;
    getpeername(handle_, reinterpret_cast<sockaddr*>(&other), &size);
    address_ = name_of(other, size).first;
}

UdpSender::~UdpSender() {
    close(handle_);
}

bool UdpSender::send(std::span<const std::byte> bytes) {
    return send_to(handle_, bytes);
}

UdpLink::UdpLink(const Endpoint& endpoint, std::string_view option)
    : handle_(open_socket(endpoint, option, connect, "a host that can be reached")) {
    sockaddr_storage other{};
    socklen_t size = sizeof other;
    getpeername(handle_, reinterpret_cast<sockaddr*>(&other), &size);
    address_ = name_of(other, size).first;
}

UdpLink::~UdpLink() {
    close(handle_);
}

bool UdpLink::send(std::span<const std::byte> bytes) {
    return send_to(handle_, bytes);
}

int UdpLink::receive(const std::function<void(const Datagram&)>& take, int most) {
    return receive_from(handle_, take, most);
}

void UdpLink::wait(double seconds) const {
    pollfd what{handle_, POLLIN, 0};
    poll(&what, 1, static_cast<int>(seconds * 1000));
}

} // namespace sward::feed
