// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "scene/heightfield.h"

namespace sward::scene {
namespace {

using nlohmann::json;

constexpr std::uint64_t kHeaderLimit = 65536;
constexpr int kMostSide = 16384;
constexpr std::uint64_t kMostPosts = std::uint64_t{1} << 28;
constexpr double kLeastSpacing_m = 0.001, kMostSpacing_m = 1e5;
const std::vector<std::string> kKeys = {"width", "height", "spacing_m"};

/// The header's fields, checked; `metres` is left empty.
Heightfield read_header(const std::filesystem::path& path) {
    const auto bad = [&](std::string_view what, std::string_view found, std::string_view expected,
                         base::ExitCode code = base::ExitCode::kBadInput) {
        return base::input_error(code, path, 0, what, found, expected);
    };
    json header;
    try {
        header = json::parse(base::read_text(path, kHeaderLimit));
    } catch (const json::exception& error) {
        throw bad("not valid JSON", error.what(), "a JSON object");
    }
    if (!header.is_object())
        throw bad("header", header.type_name(), "a JSON object");
    for (const auto& [key, value] : header.items())
        if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
            throw bad("unknown key", key, "width, height, spacing_m");

    const auto side = [&](const char* key) {
        const auto it = header.find(key);
        if (it == header.end() || !it->is_number_unsigned() || it->get<std::uint64_t>() < 2)
            throw bad(key,
                      it == header.end() ? "nothing"
                                         : it->dump(-1, ' ', true, json::error_handler_t::replace),
                      fmt::format("a whole number from 2 to {}", kMostSide));
        if (it->get<std::uint64_t>() > kMostSide)
            throw bad(key, it->dump(), fmt::format("at most {}", kMostSide),
                      base::ExitCode::kOverLimit);
        return it->get<int>();
    };
    Heightfield field;
    field.width = side("width");
    field.height = side("height");
    const auto spacing = header.find("spacing_m");
    if (spacing == header.end() || !spacing->is_array() || spacing->size() != 2)
        throw bad("spacing_m", spacing == header.end() ? "nothing" : spacing->type_name(),
                  "[x, z] in metres");
    for (int i = 0; i < 2; ++i) {
        const json& value = (*spacing)[i];
        const double metres = value.is_number() ? value.get<double>() : NAN;
        if (!(metres >= kLeastSpacing_m && metres <= kMostSpacing_m))
            throw bad(fmt::format("spacing_m[{}]", i),
                      value.dump(-1, ' ', true, json::error_handler_t::replace),
                      fmt::format("a number from {} to {} m", kLeastSpacing_m, kMostSpacing_m));
        field.spacing_m[i] = metres;
    }
    return field;
}

} // namespace

Heightfield read_raw_elevation(const std::filesystem::path& path) {
    Heightfield field = read_header(std::filesystem::path(path).replace_extension(".json"));
    const std::uint64_t posts = std::uint64_t(field.width) * std::uint64_t(field.height);
    if (posts > kMostPosts)
        throw base::input_error(base::ExitCode::kOverLimit, path, 0, "too many posts",
                                fmt::format("{}", posts), fmt::format("at most {}", kMostPosts));
    const std::vector<std::byte> bytes = base::read_file(path, kMostPosts * sizeof(float));
    if (bytes.size() != posts * sizeof(float))
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "size of the file",
                                fmt::format("{} bytes", bytes.size()),
                                fmt::format("{} bytes for {} x {} posts", posts * sizeof(float),
                                            field.width, field.height));
    field.metres.resize(posts);
    for (std::size_t i = 0; i < posts; ++i) {
        std::uint32_t word = 0;
        for (std::size_t b = 0; b < 4; ++b)
            word |= std::to_integer<std::uint32_t>(bytes[4 * i + b]) << (8 * b);
        field.metres[i] = std::bit_cast<float>(word);
        if (!std::isfinite(field.metres[i]))
            throw base::input_error(
                base::ExitCode::kBadInput, path, 0,
                fmt::format("height at column {}, row {}", i % field.width, i / field.width),
                fmt::format("{}", field.metres[i]), "a finite number");
    }
    return field;
}

Heightfield read_raw16(const std::filesystem::path& path, glm::dvec2 size_m, glm::dvec2 height_m) {
    const std::vector<std::byte> bytes = base::read_file(path, kMostPosts * 2);
    const auto side = static_cast<std::uint64_t>(std::llround(std::sqrt(double(bytes.size() / 2))));
    if (side < 2 || side * side * 2 != bytes.size())
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "size of the file",
                                fmt::format("{} bytes", bytes.size()),
                                "a square of 16-bit posts: 2 x N x N bytes");
    if (side > kMostSide)
        throw base::input_error(base::ExitCode::kOverLimit, path, 0, "size",
                                fmt::format("{0} x {0}", side),
                                fmt::format("at most {} a side", kMostSide));
    Heightfield field;
    field.width = field.height = static_cast<int>(side);
    field.spacing_m = size_m / double(side - 1);
    field.metres.reserve(side * side);
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        const unsigned word =
            std::to_integer<unsigned>(bytes[i]) | std::to_integer<unsigned>(bytes[i + 1]) << 8;
        field.metres.push_back(
            static_cast<float>(height_m.x + (height_m.y - height_m.x) * (word / 65535.0)));
    }
    return field;
}

} // namespace sward::scene
