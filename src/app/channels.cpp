// SPDX-License-Identifier: Apache-2.0
#include "app/channels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "base/angles.h"
#include "base/error.h"
#include "base/file.h"
#include "scene/toml_reader.h"

namespace sward::app {
namespace {

using scene::Range;
using scene::TableReader;

constexpr std::uint64_t kLimit = 1u << 16; // bytes of the file
constexpr std::size_t kMostChannels = 16;  // each holds targets of its own on the GPU
constexpr double kLargestSide = 16384;
constexpr double kWidest_deg = 85; // beyond, a picture plane is all rim
constexpr Range kTurn{-180, 180, "degrees"};
constexpr Range kSide{1, kLargestSide, "pixels"};

double tangent(double angle_deg) {
    return std::tan(angle_deg * base::kDegree);
}

Tangents read_rim(TableReader& table, glm::ivec2 size) {
    constexpr Range kAngle{-kWidest_deg, kWidest_deg, "degrees"};
    std::vector<double> n;
    double fov_deg = 0;
    const bool given = table.numbers("frustum_deg", n, {kAngle, kAngle, kAngle, kAngle});
    const bool centred = table.number("fov_deg", fov_deg, {1, 2 * kWidest_deg, "degrees"});
    if (given == centred)
        throw table.error("frustum_deg", given ? "fov_deg beside it" : "nothing",
                          "frustum_deg = [left, right, bottom, top] or fov_deg, one of the two");
    if (given) {
        if (!(n[0] < n[1] && n[2] < n[3]))
            throw table.error("frustum_deg", fmt::format("{}, {}, {}, {}", n[0], n[1], n[2], n[3]),
                              "left below right, bottom below top");
        return {tangent(n[0]), tangent(n[1]), tangent(n[2]), tangent(n[3])};
    }
    const double high = tangent(fov_deg / 2), wide = high * size.x / size.y;
    return {-wide, wide, -high, high};
}

glm::ivec2 read_pixels(TableReader& table, const char* key, const Range& range,
                       glm::ivec2 otherwise) {
    std::vector<double> n;
    if (!table.numbers(key, n, {range, range}))
        return otherwise;
    if (n[0] != std::floor(n[0]) || n[1] != std::floor(n[1]))
        throw table.error(key, fmt::format("{}, {}", n[0], n[1]), "whole pixels");
    return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

/// `right`: where the channel before it ends.
Channel read_channel(TableReader& table, int right) {
    Channel channel;
    table.name("name", channel.name);
    channel.size = read_pixels(table, "size", kSide, {0, 0});
    channel.at = read_pixels(table, "at", {0, kLargestSide, "pixels"}, {right, 0});
    table.number("yaw_deg", channel.turn.yaw_deg, kTurn);
    table.number("pitch_deg", channel.turn.pitch_deg, {-90, 90, "degrees"});
    table.number("roll_deg", channel.turn.roll_deg, kTurn);
    constexpr Range kOffset{-100, 100, "m"};
    std::vector<double> n;
    if (table.numbers("offset_m", n, {kOffset, kOffset, kOffset}))
        channel.turn.position = {n[0], n[1], -n[2]};
    bool mirror = false;
    table.boolean("mirror", mirror);
    table.require("name");
    table.require("size");
    channel.rim = read_rim(table, channel.size);
    table.finish();
    if (mirror)
        std::swap(channel.rim.left, channel.rim.right);
    return channel;
}

} // namespace

std::vector<Channel> read_channels(const std::filesystem::path& file) {
    const toml::table whole = scene::parse_toml(base::read_text(file, kLimit), file);
    TableReader reader(whole, file, "");
    std::vector<Channel> channels;
    for (TableReader& table : reader.tables("channel", kMostChannels)) {
        const int right = channels.empty() ? 0 : channels.back().at.x + channels.back().size.x;
        Channel channel = read_channel(table, right);
        if (std::any_of(channels.begin(), channels.end(),
                        [&](const Channel& other) { return other.name == channel.name; }))
            throw table.error("name", channel.name, "a name that no other channel has");
        channels.push_back(std::move(channel));
    }
    reader.finish();
    if (channels.empty())
        throw reader.error("channel", "nothing", "[[channel]] once or more");
    if (const glm::ivec2 all = extent_of(channels);
        std::max(all.x, all.y) > static_cast<int>(kLargestSide))
        throw reader.error("channel", fmt::format("a window of {} x {} pixels", all.x, all.y),
                           fmt::format("at most {} a side", kLargestSide));
    return channels;
}

Camera channel_camera(const Camera& middle, const Channel& channel) {
    Camera camera;
    camera.view_from_world = view_from_world(channel.turn) * middle.view_from_world;
    camera.clip_from_view = projection(channel.rim);
    return camera;
}

glm::ivec2 extent_of(const std::vector<Channel>& channels) {
    glm::ivec2 all(0);
    for (const Channel& channel : channels)
        all = glm::max(all, channel.at + channel.size);
    return all;
}

std::filesystem::path channel_file(const std::filesystem::path& file, const Channel& channel) {
    std::filesystem::path out = file;
    out.replace_filename(file.stem().string() + "-" + channel.name + file.extension().string());
    return out;
}

} // namespace sward::app
