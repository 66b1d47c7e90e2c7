// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "feed/net_fdm.h"
#include "scene/scene.h"

namespace sward::feed {

inline constexpr double kExtrapolated_s =
    0.1; ///< that a pose is carried on after its packet came, at most
inline constexpr double kSilence_s = 0.5; ///< after which a stream stands, and another may begin
inline constexpr double kHeld_s =
    0.25; ///< after which a packet that comes again means that the aircraft stands there

/// An aircraft in the scene's world: metres, y above the datum; yaw 0 looks along -z; roll positive
/// lowers the right wing.
struct FeedPose {
    glm::dvec3 position{0};
    glm::dvec3 velocity_mps{0};
    double yaw_deg = 0, pitch_deg = 0, roll_deg = 0;
};

/// What became of a packet.
enum class Packet {
    kTaken,
    kVersion,
    kSize,
    kNumber,
    kRange,   ///< as FdmFault; kRange also for a place that the scene's frame does not hold
    kForeign, ///< another sender than the stream's
    kDoubled, ///< the one before once more
    kOld,     ///< from before the one before: replayed, or late
    kCount
};
[[nodiscard]] std::string_view name_of(Packet packet);

enum class Stream {
    kWaiting, ///< nothing has come
    kLive,
    kPaused, ///< packets come, and say the same
    kSilent, ///< nothing comes any more
};

/// The way of one aircraft out of packets, which may be late, lost, doubled, old or somebody
/// else's. Times are seconds of one clock that never goes back. A stream belongs to its first
/// sender until it has been silent for kSilence_s; what comes after that begins a new one.
class PoseTrack {
public:
    /// Throws nothing later: a place that `on_earth` cannot hold is a bad packet.
    explicit PoseTrack(scene::PlaceOnEarth on_earth);

    /// Takes a packet that came from `sender` (any name of it) at `arrival_s`. All but kTaken leave
    /// the pose as it is, but for a kDoubled later than kHeld_s: the sender stands there, so the
    /// pose goes back to where it says.
    Packet take(std::span<const std::byte> packet, std::string_view sender, double arrival_s);

    /// The pose carried on to `now_s`; nothing before the first packet.
    [[nodiscard]] std::optional<FeedPose> pose(double now_s) const;
    /// The pose as the packet has it.
    [[nodiscard]] std::optional<FeedPose> said() const;
    [[nodiscard]] Stream stream(double now_s) const;
    /// For how long the pose has said nothing new.
    [[nodiscard]] double age_s(double now_s) const;
    /// The packet that the pose is of; null before the first.
    [[nodiscard]] const FdmSample* sample() const { return newest_ ? &newest_->sample : nullptr; }
    [[nodiscard]] const std::array<std::uint64_t, static_cast<std::size_t>(Packet::kCount)>&
    counts() const {
        return counts_;
    }
    [[nodiscard]] std::uint64_t count(Packet packet) const {
        return counts_[static_cast<std::size_t>(packet)];
    }

private:
    struct Fix {
        FdmSample sample;
        glm::dvec3 position{0};  ///< world
        glm::dvec2 north{0, -1}; ///< x, z of true north there, of length 1
        double arrival_s = 0;
        std::uint64_t digest = 0;
    };

    Packet judge(std::span<const std::byte> packet, std::string_view sender, double arrival_s);
    [[nodiscard]] std::optional<Packet> unwanted(const Fix& fix) const;
    [[nodiscard]] bool behind(const Fix& fix) const;
    bool settle(Fix& fix) const;
    [[nodiscard]] glm::dvec3 world_velocity(const Fix& fix) const;

    scene::PlaceOnEarth on_earth_;
    std::optional<Fix> newest_, before_;
    std::string sender_;
    double heard_s_ = 0; ///< when the stream's sender last said something that is not old
    bool held_ = false;  ///< the newest packet has come again
    std::vector<std::uint64_t> seen_; ///< digests of packets that were taken, a ring
    std::size_t next_seen_ = 0;
    std::array<std::uint64_t, static_cast<std::size_t>(Packet::kCount)> counts_{};
};

} // namespace sward::feed
