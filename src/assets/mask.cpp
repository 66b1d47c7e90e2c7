// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/gdal_scope.h"
#include "assets/image_file.h"
#include "assets/land_mask.h"
#include "assets/mask_warp.h"
#include "base/error.h"
#include "base/held_warnings.h"
#include "base/log.h"

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

/// Values of the file to what the mask is made from: densities 0..1, or classes; NaN where there is
/// no value.
void check_values(const std::filesystem::path& path, bool by_class, Channel& channel) {
    const float scale =
        by_class || channel.full_scale == 0 ? 1.0f : static_cast<float>(1 / channel.full_scale);
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
        float& pixel = channel.values[i];
        const float value = pixel * scale;
        if (std::isnan(value))
            continue;
        if (by_class) {
            if (value != std::round(value) || value < 0 || value >= kClasses)
                throw bad_pixel(path, channel, i, "a landcover class from 0 to 65535");
        } else if (value < -kSlack || value > 1 + kSlack) {
            throw bad_pixel(path, channel, i, "a density from 0 to 1");
        } else {
            pixel = std::clamp(value, 0.0f, 1.0f);
        }
    }
}

scene::DensityMask load(const scene::TerrainSpec& spec, const scene::Heightfield* ground) {
    const GdalScope
        silence; // its libraries complain on stderr, also while coordinates are transformed
    const base::HeldWarnings held;
    ChannelRequest request;
    request.palette = spec.classes.empty() ? Palette::kColours : Palette::kIndices;
    request.band = spec.mask_band;
    const std::optional<scene::Georeference> frame = ground ? ground->origin : std::nullopt;
    request.frame = frame ? &*frame : nullptr;
    Channel channel = read_channel(spec.mask, request);
    check_values(spec.mask, !spec.classes.empty(), channel);
    if (ground && spec.has_land())
        return land_mask(&channel, spec, *ground);
    const MaskTable table(spec.classes);
    if (channel.placement)
        return warp_mask(channel, table, *ground, spec.mask);
    if (frame && channel.turned_loose)
        base::log_warning(base::printable(spec.mask.native(), 1024) +
                          ": a geotransform without a CRS; spread over the whole terrain");
    return spread_mask(std::move(channel), table);
}

} // namespace

scene::DensityMask load_mask(const scene::TerrainSpec& spec, const scene::Heightfield& ground) {
    if (spec.mask.empty()) // areas and lines alone
        return land_mask(nullptr, spec, ground);
    return load(spec, &ground);
}

scene::DensityMask load_mask(const std::filesystem::path& path,
                             const std::map<int, double>& classes) {
    scene::TerrainSpec spec;
    spec.mask = path;
    spec.classes.insert(classes.begin(), classes.end());
    return load(spec, nullptr);
}

} // namespace sward::assets
