// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/image_file.h"
#include "base/error.h"

namespace sward::assets {
namespace {

constexpr float kSlack = 1e-3f; // what rounding to half floats may leave outside 0..1

base::Error bad_pixel(const std::filesystem::path& path, const Channel& channel, std::size_t pixel,
                      std::string_view expected) {
    const std::size_t width = static_cast<std::size_t>(channel.width);
    return base::input_error(
        base::ExitCode::kBadInput, path, 0,
        fmt::format("pixel at column {}, row {}", pixel % width, pixel / width),
        fmt::format("{}", channel.values[pixel]), expected);
}

} // namespace

scene::DensityMask load_mask(const std::filesystem::path& path,
                             const std::map<int, double>& classes) {
    const bool by_class = !classes.empty();
    Channel channel = read_first_channel(path, 1, by_class ? Palette::kIndices : Palette::kColours);
    const float scale =
        by_class || channel.full_scale == 0 ? 1.0f : static_cast<float>(1 / channel.full_scale);
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
        const float value = channel.values[i] * scale;
        if (by_class) {
            if (value != std::round(value) || value < 0 || value > 65535)
                throw bad_pixel(path, channel, i, "a landcover class from 0 to 65535");
            const auto it = classes.find(static_cast<int>(value));
            channel.values[i] = it == classes.end() ? 0.0f : static_cast<float>(it->second);
        } else if (value < -kSlack || value > 1 + kSlack) {
            throw bad_pixel(path, channel, i, "a density from 0 to 1");
        } else {
            channel.values[i] = std::clamp(value, 0.0f, 1.0f);
        }
    }
    return {channel.width, channel.height, std::move(channel.values)};
}

} // namespace sward::assets
