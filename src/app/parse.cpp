// SPDX-License-Identifier: Apache-2.0
#include "app/parse.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

namespace sward::app {
namespace {

constexpr int kLargestSide = 16384;
constexpr int kLastFrame = 999'999;
constexpr std::array<std::string_view, 7> kAovs = {"color",   "depth",  "tier", "coverage",
                                                   "tangent", "normal", "rank"};

/// The number that is the whole of `text`, or nothing: no blanks, no '+', no nan, no overflow.
template<class T> std::optional<T> whole_number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return {};
    return value;
}

std::string range_text(NumberRange range, std::string_view kind) {
    return fmt::format("{} from {} to {}", range.unit.empty() ? kind : range.unit, range.least,
                       range.most);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos)
            return parts;
        text.remove_prefix(at + 1);
    }
}

int parse_side(std::string_view option, std::string_view text, std::string_view whole) {
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    const bool zero = digits && text.find_first_not_of('0') == std::string_view::npos;
    if (!digits || zero)
        throw option_error(option, whole, "WIDTHxHEIGHT in pixels, such as 1280x720");
    // Digits that do not even fit are over the limit like any other.
    const long long side =
        whole_number<long long>(text).value_or(std::numeric_limits<long long>::max());
    if (side > kLargestSide)
        throw option_error(option, whole, fmt::format("at most {} a side", kLargestSide),
                           base::ExitCode::kOverLimit);
    return static_cast<int>(side);
}

} // namespace

base::Error option_error(std::string_view option, std::string_view found, std::string_view expected,
                         base::ExitCode code) {
    return {code,
            fmt::format("{}: found \"{}\", expected {}", option, base::printable(found), expected)};
}

double parse_number(std::string_view option, std::string_view text, NumberRange range) {
    const auto value = whole_number<double>(text);
    if (!value || !std::isfinite(*value) || *value < range.least || *value > range.most)
        throw option_error(option, text, range_text(range, "a number"));
    return *value;
}

long long parse_integer(std::string_view option, std::string_view text, NumberRange range) {
    const auto value = whole_number<long long>(text);
    if (!value || static_cast<double>(*value) < range.least ||
        static_cast<double>(*value) > range.most)
        throw option_error(option, text, range_text(range, "a whole number"));
    return *value;
}

std::pair<int, int> parse_size(std::string_view option, std::string_view text) {
    const auto sides = split(text, 'x');
    if (sides.size() != 2)
        throw option_error(option, text, "WIDTHxHEIGHT in pixels, such as 1280x720");
    return {parse_side(option, sides[0], text), parse_side(option, sides[1], text)};
}

WindowPlace parse_window(std::string_view option, std::string_view text) {
    constexpr int kFarthest = 32767; // X11's own limit
    const auto fail = [&] {
        return option_error(option, text,
                            "WIDTHxHEIGHT or WIDTHxHEIGHT+X+Y in pixels, such as 1280x720+100+50");
    };
    const auto parts = split(text, '+');
    if (parts.size() != 1 && parts.size() != 3)
        throw fail();
    const auto sides = split(parts[0], 'x');
    if (sides.size() != 2)
        throw fail();
    WindowPlace place{parse_side(option, sides[0], text), parse_side(option, sides[1], text), {}};
    if (parts.size() == 1)
        return place;
    const auto x = whole_number<int>(parts[1]), y = whole_number<int>(parts[2]);
    if (!x || !y || std::abs(*x) > kFarthest || std::abs(*y) > kFarthest)
        throw fail();
    place.at = glm::ivec2(*x, *y);
    return place;
}

double parse_step(std::string_view option, std::string_view text, NumberRange range) {
    const auto parts = split(text, '/');
    if (parts.size() != 2)
        return parse_number(option, text, range);
    const auto over = whole_number<double>(parts[0]), under = whole_number<double>(parts[1]);
    const double step = over && under ? *over / *under : 0;
    if (!std::isfinite(step) || step < range.least || step > range.most)
        throw option_error(option, text,
                           range_text(range, "a number") + ", or a fraction such as 1/144");
    return step;
}

FrameRange parse_frames(std::string_view option, std::string_view text) {
    const auto ends = split(text, ':');
    const auto frame = [&](std::string_view part) {
        const auto value = whole_number<int>(part);
        if (ends.size() != 2 || !value || *value < 0 || *value > kLastFrame)
            throw option_error(option, text,
                               fmt::format("FIRST:LAST, whole numbers from 0 to {}", kLastFrame));
        return *value;
    };
    const FrameRange range{frame(ends.front()), frame(ends.back())};
    if (range.first > range.last)
        throw option_error(option, text, "FIRST:LAST with FIRST not above LAST");
    return range;
}

std::vector<std::string> parse_aovs(std::string_view option, std::string_view text) {
    std::vector<std::string> names;
    for (const std::string_view part : split(text, ',')) {
        if (std::find(kAovs.begin(), kAovs.end(), part) == kAovs.end() ||
            std::find(names.begin(), names.end(), part) != names.end())
            throw option_error(option, part,
                               fmt::format("each once, of {}", fmt::join(kAovs, ",")));
        names.emplace_back(part);
    }
    return names;
}

blades::CullTests parse_cull(std::string_view option, std::string_view text) {
    blades::CullTests tests{false, false, false, false, false};
    const std::array<std::pair<std::string_view, bool*>, 5> known = {
        {{"frustum", &tests.frustum},
         {"orientation", &tests.orientation},
         {"distance", &tests.distance},
         {"occlusion", &tests.occlusion},
         {"samples", &tests.samples}}};
    if (text == "none")
        return tests;
    for (const std::string_view part : split(text, ',')) {
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&](const auto& test) { return test.first == part; });
        if (found == known.end() || *found->second)
            throw option_error(
                option, text,
                "none, or each once, of frustum,orientation,distance,occlusion,samples");
        *found->second = true;
    }
    return tests;
}

scene::Pose parse_eye(const std::string& option, const std::string& text) {
    // Where distances are measured from has no direction, so the pose may end after z.
    const bool short_form = std::count(text.begin(), text.end(), ',') == 2;
    try {
        return scene::parse_pose(short_form ? text + ",0,0" : text, option);
    } catch (const base::Error&) {
        throw option_error(option, text, "x,y,z in metres, or a pose x,y,z,yaw,pitch");
    }
}

feed::Endpoint parse_endpoint(std::string_view option, std::string_view text,
                              std::string_view expected) {
    if (const auto endpoint = feed::parse_endpoint(text))
        return *endpoint;
    throw option_error(option, text, expected);
}

glm::dvec2 parse_place(std::string_view option, std::string_view text) {
    constexpr NumberRange kPlace{-1e6, 1e6, "metres"};
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos)
        throw option_error(option, text, "x,z");
    return {parse_number(option, text.substr(0, comma), kPlace),
            parse_number(option, text.substr(comma + 1), kPlace)};
}

} // namespace sward::app
