// SPDX-License-Identifier: Apache-2.0
#include "grass/far_light.h"

#include <array>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"
#include "grass/grass_set.h"

namespace sward::grass {
namespace {

using Texel = std::array<float, 4>;

float in_range(float value, float high, std::string_view what, const std::filesystem::path& name) {
    if (!(value >= 0 && value <= high))
        throw base::input_error(base::ExitCode::kBadInput, name, 0, what, fmt::format("{}", value),
                                fmt::format("a number from 0 to {}", high));
    return value;
}

} // namespace

TextureArray encode_far_light(const FarLight& light) {
    TextureArray array{light.sun_azimuths,
                       static_cast<int>(light.sun_elevations_deg.size()),
                       2 * static_cast<int>(light.images()),
                       {},
                       TexelFormat::kRgba32f};
    const std::size_t plane =
        light.sun_elevations_deg.size() * static_cast<std::size_t>(light.sun_azimuths);
    auto& bytes = array.mips.emplace_back(2 * light.samples.size() * sizeof(Texel));
    for (std::size_t n = 0; n < light.samples.size(); ++n) {
        const FarSample& s = light.samples[n];
        const std::size_t at = n / plane * 2 * plane + n % plane;
        const Texel sun{s.sun.x, s.sun.y, s.sun.z, s.coverage},
            sky{s.sky.x, s.sky.y, s.sky.z, s.height};
        std::memcpy(bytes.data() + at * sizeof(Texel), sun.data(), sizeof(Texel));
        std::memcpy(bytes.data() + (at + plane) * sizeof(Texel), sky.data(), sizeof(Texel));
    }
    return array;
}

void decode_far_light(const TextureArray& array, const std::filesystem::path& name,
                      FarLight& light) {
    const std::size_t plane =
        light.sun_elevations_deg.size() * static_cast<std::size_t>(light.sun_azimuths);
    const auto expect = [&](std::string_view what, std::size_t found, std::size_t expected) {
        if (found != expected)
            throw base::input_error(base::ExitCode::kBadInput, name, 0, what, std::to_string(found),
                                    fmt::format("{} as the axes in set.json say", expected));
    };
    if (array.format != TexelFormat::kRgba32f)
        throw base::input_error(base::ExitCode::kBadInput, name, 0, "format", "another", "RGBA32F");
    expect("width", static_cast<std::size_t>(array.width),
           static_cast<std::size_t>(light.sun_azimuths));
    expect("height", static_cast<std::size_t>(array.height), light.sun_elevations_deg.size());
    expect("images", static_cast<std::size_t>(array.layers), 2 * light.images());
    light.samples.resize(light.images() * plane);
    for (std::size_t n = 0; n < light.samples.size(); ++n) {
        const std::size_t at = n / plane * 2 * plane + n % plane;
        Texel sun, sky;
        std::memcpy(sun.data(), array.mips[0].data() + at * sizeof(Texel), sizeof(Texel));
        std::memcpy(sky.data(), array.mips[0].data() + (at + plane) * sizeof(Texel), sizeof(Texel));
        FarSample& s = light.samples[n];
        for (std::size_t c = 0; c < 3; ++c) {
            s.sun[static_cast<int>(c)] = in_range(sun[c], kMaxReflectance, "sun", name);
            s.sky[static_cast<int>(c)] = in_range(sky[c], kMaxReflectance, "sky", name);
        }
        s.coverage = in_range(sun[3], 1, "coverage", name);
        s.height = in_range(sky[3], 1, "height", name);
    }
}

} // namespace sward::grass
