// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/ranges.h"
#include "scene/scene.h"

namespace sward::scene {
namespace {

constexpr std::string_view kAbsolute = "abs:";
constexpr std::string_view kGeo = "geo:";
constexpr std::array<const char*, 5> kFields = {"x", "y", "z", "yaw", "pitch"};
constexpr std::array<const char*, 5> kGeoFields = {"latitude", "longitude", "height", "yaw",
                                                   "pitch"};
constexpr std::array<Range, 5> kRanges = {kPlace, kHeight, kPlace, kYaw, kPitch};
constexpr std::array<Range, 5> kGeoRanges = {kLatitude, kLongitude, kHeight, kYaw, kPitch};

base::Error usage(const std::string& option, std::string_view found, std::string_view expected) {
    return {base::ExitCode::kUsage,
            fmt::format("{}: found {}, expected {}", option, found, expected)};
}

/// The turn from `from` to `to`, -180 to 180.
double shortest_turn(double from_deg, double to_deg) {
    return std::remainder(to_deg - from_deg, 360.0);
}

/// Catmull-Rom on uneven times: the slope at a key is that between its neighbours; one-sided at the
/// ends.
glm::dvec3 slope(const std::vector<PathKey>& keys, std::size_t i) {
    const PathKey& before = keys[i > 0 ? i - 1 : 0];
    const PathKey& after = keys[std::min(i + 1, keys.size() - 1)];
    return (after.position - before.position) / (after.t_s - before.t_s);
}

glm::dvec3 hermite(const std::vector<PathKey>& keys, std::size_t i, double u) {
    const PathKey &a = keys[i], &b = keys[i + 1];
    const double span = b.t_s - a.t_s, u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * a.position + (3 * u2 - 2 * u3) * b.position +
           (u3 - 2 * u2 + u) * span * slope(keys, i) + (u3 - u2) * span * slope(keys, i + 1);
}

} // namespace

Pose sample_path(const Path& path, double time_s) {
    Pose pose;
    pose.agl = path.agl;
    pose.fov_deg = path.fov_deg;
    if (path.keys.empty())
        return pose;
    const auto hold = [&](const PathKey& key) {
        pose.position = key.position;
        pose.yaw_deg = key.yaw_deg;
        pose.pitch_deg = key.pitch_deg;
        return pose;
    };
    if (!(time_s > path.keys.front().t_s)) // NaN too
        return hold(path.keys.front());
    if (time_s >= path.keys.back().t_s)
        return hold(path.keys.back());
    const auto next = std::upper_bound(path.keys.begin(), path.keys.end(), time_s,
                                       [](double t, const PathKey& key) { return t < key.t_s; });
    const auto i = static_cast<std::size_t>(next - path.keys.begin()) - 1;
    const PathKey &a = path.keys[i], &b = path.keys[i + 1];
    const double u = (time_s - a.t_s) / (b.t_s - a.t_s);
    pose.position = hermite(path.keys, i, u);
    pose.yaw_deg = a.yaw_deg + u * shortest_turn(a.yaw_deg, b.yaw_deg);
    pose.pitch_deg = a.pitch_deg + u * (b.pitch_deg - a.pitch_deg);
    return pose;
}

Pose object_pose(const ObjectSpec& object, const std::map<std::string, Path>& paths,
                 double time_s) {
    Pose pose;
    if (const auto path = paths.find(object.path); path != paths.end()) {
        pose = sample_path(path->second, time_s);
    } else {
        pose.position = object.position;
        pose.agl = object.agl;
    }
    pose.yaw_deg += object.yaw_deg;
    return pose;
}

Pose parse_pose(const std::string& text, const std::string& option) {
    constexpr const char* kForm =
        "x,y,z,yaw,pitch or abs:x,y,z,yaw,pitch or geo:LAT,LON,HEIGHT,YAW,PITCH";
    const std::string found = text.empty() ? "nothing" : base::printable(text);
    Pose pose;
    std::string_view rest = text;
    pose.agl = !rest.starts_with(kAbsolute);
    if (!pose.agl)
        rest.remove_prefix(kAbsolute.size());
    const bool geo = rest.starts_with(kGeo);
    if (geo)
        rest.remove_prefix(kGeo.size());

    std::array<double, 5> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t comma = rest.find(',');
        const bool last = i + 1 == values.size();
        if ((comma == std::string_view::npos) != last)
            throw usage(option, found, kForm);
        const std::string_view field = rest.substr(0, comma);
        const auto result = std::from_chars(field.data(), field.data() + field.size(), values[i]);
        if (result.ptr != field.data() + field.size() || result.ec == std::errc::invalid_argument)
            throw usage(option, found, kForm);
        const Range& range = geo ? kGeoRanges[i] : kRanges[i];
        if (result.ec != std::errc() || !(values[i] >= range.low && values[i] <= range.high))
            throw usage(
                option,
                fmt::format("{} = {}", geo ? kGeoFields[i] : kFields[i], base::printable(field)),
                fmt::format("a number from {} to {} {}", range.low, range.high, range.unit));
        rest.remove_prefix(last ? rest.size() : comma + 1);
    }
    if (geo)
        pose.geo = glm::dvec2(values[0], values[1]);
    pose.position = geo ? glm::dvec3(0, values[2], 0) : glm::dvec3(values[0], values[1], values[2]);
    pose.yaw_deg = values[3];
    pose.pitch_deg = values[4];
    return pose;
}

namespace {

/// Places may lie as far from the middle as files may write them.
void settle(std::optional<glm::dvec2>& geo, glm::dvec3& position, const PlaceOnEarth& on_earth,
            const std::string& what) {
    if (!geo)
        return;
    const base::ExitCode code =
        what.starts_with("--") ? base::ExitCode::kUsage : base::ExitCode::kBadInput;
    const std::string found = fmt::format("latitude {}, longitude {}", geo->x, geo->y);
    if (!on_earth)
        throw base::Error(
            code, fmt::format("{}: found {}, expected x and z: the terrain has no place on Earth",
                              what, found));
    const glm::dvec2 place = on_earth(geo->x, geo->y);
    if (!(std::abs(place.x) <= kPlace.high && std::abs(place.y) <= kPlace.high))
        throw base::Error(
            code,
            fmt::format(
                "{}: found {}, {:.0f} km from the terrain's middle, expected at most {:.0f} km",
                what, found, glm::length(place) / 1000, kPlace.high / 1000));
    position.x = place.x;
    position.z = place.y;
    geo.reset();
}

} // namespace

void settle_place(Pose& pose, const PlaceOnEarth& on_earth, const std::string& what) {
    settle(pose.geo, pose.position, on_earth, what);
}

void settle_places(Scene& scene, const PlaceOnEarth& on_earth) {
    const std::string file = base::printable(scene.file.native(), 1024) + ": ";
    for (auto& [name, camera] : scene.cameras)
        settle_place(camera, on_earth, file + "camera." + name + ".geo");
    for (auto& [name, path] : scene.paths)
        for (PathKey& key : path.keys)
            settle(key.geo, key.position, on_earth, file + "path." + name + ".keys.geo");
    for (ObjectSpec& object : scene.objects)
        settle(object.geo, object.position, on_earth, file + "object.geo");
}

std::string format_pose(const Pose& pose) {
    const auto thousandths = [](double value) {
        return std::round(value * 1000) / 1000 + 0.0; // + 0: no "-0.000"
    };
    return fmt::format("{}{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}", pose.agl ? "" : kAbsolute,
                       thousandths(pose.position.x), thousandths(pose.position.y),
                       thousandths(pose.position.z), thousandths(std::fmod(pose.yaw_deg, 360)),
                       thousandths(pose.pitch_deg));
}

} // namespace sward::scene
