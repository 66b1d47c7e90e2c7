// SPDX-License-Identifier: Apache-2.0
#include "feed/pose_track.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/angles.h"
#include "base/hash.h"
#include "scene/ranges.h"

namespace sward::feed {
namespace {

using base::kDegree;
constexpr std::size_t kRemembered = 2048; // packets: half a minute at 60 a second
constexpr double kMostSpin = 20;          // rad/s; a faster one is a sender's rounding at the pole
constexpr double kNorthStep_deg = 1e-4;   // 11 m
constexpr double kLeastStep_m = 0.05;     // a stride from which the way can be told from a shiver
constexpr double kMostStridesLate = 30;   // farther back, the aircraft has been put elsewhere;
                                          // likewise if the last stride is as much longer

std::uint64_t digest_of(std::span<const std::byte> packet) {
    std::uint64_t digest = packet.size();
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < packet.size(); ++i) {
        word = (word << 8) | std::to_integer<std::uint64_t>(packet[i]);
        if (i % 8 == 7 || i + 1 == packet.size())
            digest = base::hash64(digest, word, i), word = 0;
    }
    return digest;
}

Packet packet_of(FdmFault fault) {
    switch (fault) {
    case FdmFault::kVersion:
        return Packet::kVersion;
    case FdmFault::kSize:
        return Packet::kSize;
    case FdmFault::kNumber:
        return Packet::kNumber;
    case FdmFault::kRange:
        return Packet::kRange;
    case FdmFault::kNone:
        break;
    }
    return Packet::kTaken;
}

/// From the aircraft's axes (ahead, right, down) to north, east, down.
glm::dquat turn_of(glm::dvec3 attitude) {
    return glm::angleAxis(attitude.z, glm::dvec3(0, 0, 1)) *
           glm::angleAxis(attitude.y, glm::dvec3(0, 1, 0)) *
           glm::angleAxis(attitude.x, glm::dvec3(1, 0, 0));
}

/// The rates of roll, pitch and heading as a spin about the aircraft's own axes, which has no pole.
glm::dvec3 spin_of(const FdmSample& s) {
    const double sin_roll = std::sin(s.attitude_rad.x), cos_roll = std::cos(s.attitude_rad.x);
    const double sin_pitch = std::sin(s.attitude_rad.y), cos_pitch = std::cos(s.attitude_rad.y);
    const glm::dvec3 spin(s.attitude_rates.x - s.attitude_rates.z * sin_pitch,
                          s.attitude_rates.y * cos_roll + s.attitude_rates.z * sin_roll * cos_pitch,
                          s.attitude_rates.z * cos_roll * cos_pitch -
                              s.attitude_rates.y * sin_roll);
    return glm::length(spin) <= kMostSpin ? spin : glm::dvec3(0); // NaN too
}

/// Roll, pitch and heading after `dt` seconds of that spin.
glm::dvec3 spun(const FdmSample& s, double dt) {
    const glm::dvec3 angle = spin_of(s) * dt;
    const double size = glm::length(angle);
    if (size < 1e-9)
        return s.attitude_rad;
    const glm::dmat3 turn =
        glm::mat3_cast(turn_of(s.attitude_rad) * glm::angleAxis(size, angle / size));
    return {std::atan2(turn[1][2], turn[2][2]), std::asin(std::clamp(-turn[0][2], -1.0, 1.0)),
            std::atan2(turn[0][1], turn[0][0])};
}

} // namespace

std::string_view name_of(Packet packet) {
    constexpr std::array<std::string_view, static_cast<std::size_t>(Packet::kCount)> kNames = {
        "taken",        "of another version", "of a wrong size", "not finite",
        "out of range", "of another sender",  "doubled",         "old"};
    return kNames[static_cast<std::size_t>(packet)];
}

PoseTrack::PoseTrack(scene::PlaceOnEarth on_earth)
    : on_earth_(std::move(on_earth)), seen_(kRemembered, 0) {}

Packet PoseTrack::take(std::span<const std::byte> packet, std::string_view sender,
                       double arrival_s) {
    const Packet verdict = judge(packet, sender, arrival_s);
    ++counts_[static_cast<std::size_t>(verdict)];
    return verdict;
}

Packet PoseTrack::judge(std::span<const std::byte> packet, std::string_view sender,
                        double arrival_s) {
    const DecodedFdm decoded = decode_fdm(packet);
    if (decoded.fault != FdmFault::kNone)
        return packet_of(decoded.fault);
    Fix fix;
    fix.sample = decoded.sample;
    fix.arrival_s = arrival_s;
    fix.digest = digest_of(packet);
    const bool running = newest_ && arrival_s - heard_s_ < kSilence_s;
    if (running && sender != sender_)
        return Packet::kForeign;
    if (running && fix.digest == newest_->digest) {
        heard_s_ = arrival_s;
        held_ = held_ || arrival_s - newest_->arrival_s > kHeld_s;
        return Packet::kDoubled;
    }
    if (!settle(fix))
        return Packet::kRange;
    if (running)
        if (const std::optional<Packet> verdict = unwanted(fix))
            return *verdict;
    before_ = running ? newest_ : std::nullopt;
    newest_ = fix;
    if (!running) {
        sender_ = sender;
        std::fill(seen_.begin(), seen_.end(),
                  0); // a flight that begins anew may say the same again
    }
    heard_s_ = arrival_s;
    held_ = false;
    seen_[next_seen_++ % kRemembered] = fix.digest;
    return Packet::kTaken;
}

std::optional<Packet> PoseTrack::unwanted(const Fix& fix) const {
    if (std::find(seen_.begin(), seen_.end(), fix.digest) != seen_.end())
        return Packet::kOld;
    const auto later =
        static_cast<std::int32_t>(fix.sample.time - newest_->sample.time); // the count may run over
    if (later < 0 || (later == 0 && behind(fix)))
        return Packet::kOld;
    return std::nullopt;
}

/// Whether a packet without a time of its own is late: nothing turns back within one stride. Wrong
/// once where something does, and put right by the silence that follows.
bool PoseTrack::behind(const Fix& fix) const {
    if (!before_)
        return false;
    const glm::dvec3 stride = newest_->position - before_->position,
                     back = fix.position - newest_->position;
    const double length = glm::length(stride);
    if (length < kLeastStep_m)
        return false;
    const double along = glm::dot(back, stride) / length;
    const double aside = glm::length(back - along * stride / length);
    return -along > length / kMostStridesLate && -along < length * kMostStridesLate &&
           aside < kLeastStep_m - 0.25 * along;
}

/// The packet's place in the world, and where north is there: the further from the terrain's
/// middle, the more the frame's own leans away.
bool PoseTrack::settle(Fix& fix) const {
    if (!on_earth_)
        return false;
    const FdmSample& s = fix.sample;
    try {
        const glm::dvec2 place = on_earth_(s.latitude_deg, s.longitude_deg);
        const double step =
            s.latitude_deg > 0 ? -kNorthStep_deg : kNorthStep_deg; // not past a pole
        const glm::dvec2 north = (on_earth_(s.latitude_deg + step, s.longitude_deg) - place) / step;
        if (!(std::abs(place.x) <= scene::kPlace.high && std::abs(place.y) <= scene::kPlace.high &&
              glm::length(north) > 0))
            return false;
        fix.position = {place.x, s.altitude_m, place.y};
        fix.north = glm::normalize(north);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

glm::dvec3 PoseTrack::world_velocity(const Fix& fix) const {
    const glm::dvec3& v = fix.sample.velocity_mps;
    const glm::dvec2 east(-fix.north.y, fix.north.x);
    const glm::dvec2 level = v.x * fix.north + v.y * east;
    return {level.x, -v.z, level.y};
}

std::optional<FeedPose> PoseTrack::pose(double now_s) const {
    if (!newest_)
        return std::nullopt;
    const double dt = held_ ? 0 : std::clamp(now_s - newest_->arrival_s, 0.0, kExtrapolated_s);
    const glm::dvec3 attitude = spun(newest_->sample, dt);
    FeedPose pose;
    pose.velocity_mps = world_velocity(*newest_);
    pose.position = newest_->position + dt * pose.velocity_mps;
    const double lean = std::atan2(newest_->north.x, -newest_->north.y);
    pose.yaw_deg = std::remainder((attitude.z + lean) / kDegree, 360.0);
    pose.pitch_deg = std::clamp(attitude.y / kDegree, -90.0, 90.0);
    pose.roll_deg = std::remainder(attitude.x / kDegree, 360.0);
    return pose;
}

std::optional<FeedPose> PoseTrack::said() const {
    return pose(newest_ ? newest_->arrival_s : 0);
}

Stream PoseTrack::stream(double now_s) const {
    if (!newest_)
        return Stream::kWaiting;
    if (age_s(now_s) < kSilence_s)
        return Stream::kLive;
    return now_s - heard_s_ < kSilence_s ? Stream::kPaused : Stream::kSilent;
}

double PoseTrack::age_s(double now_s) const {
    return newest_ ? std::max(0.0, now_s - newest_->arrival_s) : 0.0;
}

} // namespace sward::feed
