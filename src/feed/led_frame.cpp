// SPDX-License-Identifier: Apache-2.0
#include "feed/led_frame.h"

#include "feed/byte_stream.h"

namespace sward::feed {
namespace {

constexpr double kPlace_m = 1e7, kAngle_deg = 1e6, kTime_s = 1e9, kSpeed_mps = 1e4,
                 kFastest_mps = 300;
constexpr std::uint32_t kIdle = 1, kBlows = 2; // flags
constexpr std::uint32_t kSun = 1, kWind = 2;

void put_change(ByteWriter& out, const LedChange& change) {
    out.put(change.step);
    if (const Sun* const sun = std::get_if<Sun>(&change.what)) {
        out.put(kSun);
        out.put(glm::dvec3(sun->azimuth_deg, sun->elevation_deg, 0));
    } else {
        const MeanWind& wind = std::get<MeanWind>(change.what);
        out.put(kWind);
        out.put(glm::dvec3(wind.speed_mps, wind.direction_deg, wind.gust));
    }
}

/// None of another kind.
std::optional<LedChange> take_change(ByteReader& in) {
    LedChange change;
    change.step = in.take<std::uint32_t>();
    const auto kind = in.take<std::uint32_t>();
    if (kind == kSun) {
        const double azimuth = in.number(-kAngle_deg, kAngle_deg);
        change.what = Sun{azimuth, in.number(-90, 90)};
        static_cast<void>(in.number(0, 0));
        return change;
    }
    if (kind != kWind)
        return std::nullopt;
    MeanWind wind;
    wind.speed_mps = in.number(0, 60);
    wind.direction_deg = in.number(-kAngle_deg, kAngle_deg);
    wind.gust = in.number(0, 1);
    change.what = wind;
    return change;
}

void put_body(ByteWriter& out, const Body& body) {
    out.put(static_cast<std::uint32_t>(body.object));
    for (int column = 0; column < 4; ++column)
        out.put(glm::dvec3(body.world_from_body[column]));
}

Body take_body(ByteReader& in) {
    Body body;
    body.object = in.take<std::uint32_t>();
    for (int column = 0; column < 4; ++column)
        body.world_from_body[column] = glm::dvec4(in.three(kPlace_m), column == 3 ? 1 : 0);
    return body;
}

void put_blower(ByteWriter& out, const Blower& blower) {
    out.put(static_cast<std::uint32_t>(blower.kind));
    out.put(blower.place);
    out.put(blower.velocity);
    out.put(blower.yaw_deg);
    out.put(blower.speed_mps);
    out.put(glm::dvec3(blower.radius_m, blower.height_m, blower.length_m));
}

Blower take_blower(ByteReader& in) {
    Blower blower;
    blower.kind = static_cast<Blower::Kind>(in.count(2));
    blower.place = in.two(kPlace_m);
    blower.velocity = in.two(kSpeed_mps);
    blower.yaw_deg = in.number(-kAngle_deg, kAngle_deg);
    blower.speed_mps = in.number(0, kFastest_mps);
    blower.radius_m = in.number(0.05, 1000);
    blower.height_m = in.number(0, kPlace_m);
    blower.length_m = in.number(0, 10'000);
    return blower;
}

void take_lists(ByteReader& in, LedFrame& frame, bool blows, bool& known) {
    for (std::uint32_t left = in.count(kMostLedSteps); left > 0 && in.good(); --left)
        frame.eyes.push_back(in.three(kPlace_m));
    for (std::uint32_t left = in.count(kMostLedChanges); left > 0 && in.good() && known; --left)
        if (const auto change = take_change(in))
            frame.changes.push_back(*change);
        else
            known = false;
    for (std::uint32_t left = in.count(kMostLedBalls); left > 0 && in.good(); --left) {
        const glm::dvec3 centre = in.three(kPlace_m);
        frame.balls.push_back({centre, in.number(1e-3, 1e4)});
    }
    for (std::uint32_t left = in.count(kMostLedBodies); left > 0 && in.good(); --left)
        frame.bodies.push_back(take_body(in));
    frame.blows = blows;
    for (std::uint32_t left = in.count(kMostLedBlowers); left > 0 && in.good(); --left)
        frame.blowers.push_back(take_blower(in));
}

} // namespace

void encode_frame(const LedFrame& frame, std::vector<std::byte>& bytes) {
    ByteWriter out(bytes);
    out.put(frame.count);
    out.put((frame.idle ? kIdle : 0) | (frame.blows ? kBlows : 0));
    out.put(frame.place);
    out.put(frame.first_step);
    out.put(frame.time_s);
    out.put(frame.hour);
    out.put(frame.position);
    out.put(glm::dvec3(frame.yaw_deg, frame.pitch_deg, frame.roll_deg));
    out.put(frame.fov_deg);
    out.put(static_cast<std::uint32_t>(frame.eyes.size()));
    for (const glm::dvec3& eye : frame.eyes)
        out.put(eye);
    out.put(static_cast<std::uint32_t>(frame.changes.size()));
    for (const LedChange& change : frame.changes)
        put_change(out, change);
    out.put(static_cast<std::uint32_t>(frame.balls.size()));
    for (const Ball& ball : frame.balls) {
        out.put(ball.centre);
        out.put(ball.radius_m);
    }
    out.put(static_cast<std::uint32_t>(frame.bodies.size()));
    for (const Body& body : frame.bodies)
        put_body(out, body);
    out.put(static_cast<std::uint32_t>(frame.blowers.size()));
    for (const Blower& blower : frame.blowers)
        put_blower(out, blower);
}

std::optional<LedFrame> decode_frame(std::span<const std::byte> bytes, std::size_t& at) {
    ByteReader in(bytes, at);
    LedFrame frame;
    frame.count = in.take<std::uint32_t>();
    const auto flags = in.take<std::uint32_t>();
    frame.idle = (flags & kIdle) != 0;
    frame.place = in.take<std::uint32_t>();
    frame.first_step = in.take<std::uint32_t>();
    frame.time_s = in.number(0, kTime_s);
    frame.hour = in.number(0, 24);
    frame.position = in.three(kPlace_m);
    frame.yaw_deg = in.number(-kAngle_deg, kAngle_deg);
    frame.pitch_deg = in.number(-90, 90);
    frame.roll_deg = in.number(-kAngle_deg, kAngle_deg);
    frame.fov_deg = in.number(1, 170);
    bool known = flags < 4;
    take_lists(in, frame, (flags & kBlows) != 0, known);
    if (!in.good() || !known)
        return std::nullopt;
    at = in.at();
    return frame;
}

} // namespace sward::feed
