// SPDX-License-Identifier: Apache-2.0
#include "feed/lead_packets.h"

#include "feed/byte_stream.h"

namespace sward::feed {
namespace {

constexpr std::uint32_t kMagic = 0x53574c44; // "SWLD"
constexpr std::uint32_t kHello = 1, kWelcome = 2, kStatus = 3, kFrames = 4;
constexpr std::size_t kMostFrames = 64;
// A stranger who gives another's address as his own gets no more sent there than he has sent.
constexpr std::size_t kHelloBytes = 160;

ByteWriter begin(std::vector<std::byte>& bytes, std::uint32_t kind) {
    ByteWriter out(bytes);
    out.put(kMagic);
    out.put(kLeadVersion);
    out.put(kind);
    return out;
}

void put(ByteWriter& out, const LeadHead& head) {
    out.put(head.session);
    out.put(head.nonce);
    out.put(head.token);
}

LeadHead take_head(ByteReader& in) {
    const auto session = in.take<std::uint64_t>(), nonce = in.take<std::uint64_t>();
    return {session, nonce, in.take<std::uint64_t>()};
}

std::optional<LeadPacket> take_welcome(ByteReader& in) {
    WelcomePacket packet;
    packet.head = take_head(in);
    packet.first = in.take<std::uint32_t>();
    LeadStart& start = packet.start;
    start.seed = static_cast<std::int32_t>(in.take<std::uint32_t>());
    start.scene = in.take<std::uint64_t>();
    start.start_s = in.number(0, 1e9);
    start.density = in.number(0, 1);
    start.sun.azimuth_deg = in.number(-1e6, 1e6);
    start.sun.elevation_deg = in.number(-90, 90);
    start.wind.speed_mps = in.number(0, 60);
    start.wind.direction_deg = in.number(-1e6, 1e6);
    start.wind.gust = in.number(0, 1);
    return packet;
}

std::optional<LeadPacket> take_status(ByteReader& in) {
    StatusPacket packet;
    packet.head = take_head(in);
    packet.wants = in.take<std::uint32_t>();
    packet.drawn = in.take<std::uint32_t>();
    for (std::uint32_t left = in.count(kMostName); left > 0 && in.good(); --left) {
        const std::uint32_t letter = in.take<std::uint32_t>();
        if (letter < 0x20 || letter > 0x7e)
            return std::nullopt;
        packet.name += static_cast<char>(letter);
    }
    return packet;
}

std::optional<LeadPacket> take_frames(ByteReader& in, std::span<const std::byte> bytes,
                                      std::size_t& end) {
    FramesPacket packet;
    packet.head = take_head(in);
    packet.newest = in.take<std::uint32_t>();
    packet.places = in.take<std::uint32_t>();
    const std::uint32_t count = in.count(kMostFrames);
    end = in.at();
    for (std::uint32_t i = 0; i < count && in.good(); ++i) {
        std::optional<LedFrame> frame = decode_frame(bytes, end);
        if (!frame)
            return std::nullopt;
        packet.frames.push_back(std::move(*frame));
    }
    return packet;
}

} // namespace

std::vector<std::byte> encode(const HelloPacket& packet) {
    std::vector<std::byte> bytes;
    ByteWriter out = begin(bytes, kHello);
    out.put(packet.nonce);
    bytes.resize(kHelloBytes);
    return bytes;
}

std::vector<std::byte> encode(const WelcomePacket& packet) {
    std::vector<std::byte> bytes;
    ByteWriter out = begin(bytes, kWelcome);
    put(out, packet.head);
    out.put(packet.first);
    const LeadStart& start = packet.start;
    out.put(static_cast<std::uint32_t>(start.seed));
    out.put(start.scene);
    out.put(start.start_s);
    out.put(start.density);
    out.put(glm::dvec2(start.sun.azimuth_deg, start.sun.elevation_deg));
    out.put(glm::dvec3(start.wind.speed_mps, start.wind.direction_deg, start.wind.gust));
    return bytes;
}

std::vector<std::byte> encode(const StatusPacket& packet) {
    std::vector<std::byte> bytes;
    ByteWriter out = begin(bytes, kStatus);
    put(out, packet.head);
    out.put(packet.wants);
    out.put(packet.drawn);
    const std::string name = packet.name.substr(0, kMostName);
    out.put(static_cast<std::uint32_t>(name.size()));
    for (const char letter : name)
        out.put(static_cast<std::uint32_t>(letter));
    return bytes;
}

std::vector<std::byte> encode(const FramesPacket& packet, std::uint32_t count,
                              std::span<const std::byte> frames) {
    std::vector<std::byte> bytes;
    ByteWriter out = begin(bytes, kFrames);
    put(out, packet.head);
    out.put(packet.newest);
    out.put(packet.places);
    out.put(count);
    bytes.insert(bytes.end(), frames.begin(), frames.end());
    return bytes;
}

std::optional<LeadPacket> decode_lead(std::span<const std::byte> bytes) {
    ByteReader in(bytes, 0);
    const auto magic = in.take<std::uint32_t>(), version = in.take<std::uint32_t>(),
               kind = in.take<std::uint32_t>();
    if (!in.good() || magic != kMagic || version != kLeadVersion)
        return std::nullopt;
    std::optional<LeadPacket> packet;
    std::size_t end = bytes.size(); // a greeting is filled up
    switch (kind) {
    case kHello:
        packet = HelloPacket{in.take<std::uint64_t>()};
        end = kHelloBytes;
        break;
    case kWelcome:
        packet = take_welcome(in);
        end = in.at();
        break;
    case kStatus:
        packet = take_status(in);
        end = in.at();
        break;
    case kFrames:
        packet = take_frames(in, bytes, end);
        break;
    default:
        return std::nullopt;
    }
    return in.good() && end == bytes.size() ? packet : std::nullopt;
}

} // namespace sward::feed
