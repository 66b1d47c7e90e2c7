// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/gdal_raster.h"
#include "assets/gdal_scope.h"
#include "assets/image_file.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/held_warnings.h"
#include "base/log.h"
#include "base/room.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

base::Error bad(const fs::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    base::refuse_if_starved();
    return base::input_error(base::ExitCode::kBadInput, path, 0, what, found, expected);
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

/// Turns integer values into metres where the scene gives their range.
void apply_height_range(const scene::TerrainSpec& spec, double full_scale,
                        std::vector<float>& values) {
    if (!spec.height_m)
        return;
    const double low = spec.height_m->x, rise = spec.height_m->y - spec.height_m->x;
    for (float& value : values)
        value = static_cast<float>(low + rise * (double(value) / full_scale));
}

/// Gives voids (NaN) the heights around them.
void fill(const fs::path& path, int width, int height, std::vector<float>& metres) {
    if (const std::size_t filled = scene::fill_voids(width, height, metres))
        base::log_debug(fmt::format("{}: filled {} voids", path.string(), filled));
    if (std::isnan(metres.front())) // after filling, one is left only where all are
        throw bad(path, "no elevation", "voids only", "heights");
}

/// Posts of a file without a place on Earth, spread over terrain.size_m from the first to the last.
scene::Heightfield spread(const scene::TerrainSpec& spec, int width, int height,
                          std::vector<float> metres) {
    if (!spec.size_m)
        throw bad(spec.elevation, "terrain.size_m", "neither the key nor a CRS in the file",
                  "the terrain's size in metres");
    scene::Heightfield field;
    field.width = width;
    field.height = height;
    field.spacing_m = *spec.size_m / glm::dvec2(width - 1, height - 1);
    field.metres = std::move(metres);
    return field;
}

scene::Heightfield from_picture(const scene::TerrainSpec& spec) {
    ChannelRequest request;
    request.least_side = 2;
    request.band = spec.elevation_band;
    Channel channel = read_channel(spec.elevation, request);
    if (channel.full_scale > 0 && channel.full_scale < 256)
        throw bad(spec.elevation, "bits a channel", "8 or less",
                  "16, or floating point: 8 bits make steps");
    if (channel.full_scale > 0 && !spec.height_m)
        throw bad(spec.elevation, "terrain.height_m", "nothing",
                  "[metres at 0, metres at full scale]");
    if (channel.full_scale == 0 && spec.height_m)
        throw bad(spec.elevation, "terrain.height_m", "the key",
                  "none: floating point is metres already");
    apply_height_range(spec, channel.full_scale, channel.values);
    if (channel.full_scale == 0)
        std::replace_if(
            channel.values.begin(), channel.values.end(),
            [](float value) { return is_bare_void(value, false); },
            std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (std::abs(channel.values[i]) > 1e5f) // NaN: a void
            throw bad(
                spec.elevation,
                fmt::format("height at column {}, row {}", i % channel.width, i / channel.width),
                fmt::format("{} m", channel.values[i]), "-100000 to 100000 m");
    fill(spec.elevation, channel.width, channel.height, channel.values);
    return spread(spec, channel.width, channel.height, std::move(channel.values));
}

scene::Heightfield from_raster(const scene::TerrainSpec& spec) {
    Raster raster = read_gdal_raster(spec.elevation, spec.elevation_band);
    if (spec.height_m && (raster.full_scale == 0 || raster.has_unit))
        throw bad(spec.elevation, "terrain.height_m", "the key",
                  "none: only unsigned integers without a unit take it");
    apply_height_range(spec, raster.full_scale, raster.values);
    fill(spec.elevation, raster.width, raster.height, raster.values);
    if (!raster.placement) {
        scene::TerrainSpec sized = spec;
        if (!spec.size_m && raster.bare_spacing_m)
            sized.size_m = *raster.bare_spacing_m * glm::dvec2(raster.width - 1, raster.height - 1);
        return spread(sized, raster.width, raster.height, std::move(raster.values));
    }
    if (spec.size_m)
        throw bad(spec.elevation, "terrain.size_m", "the key",
                  "none: the file carries its own place and size");
    return to_local_grid(raster, spec.elevation);
}

/// Files without a first line or magic number, known by their names.
bool is_named_kind(const std::string& extension) {
    constexpr std::array<std::string_view, 4> kNamed = {".hgt", ".raw", ".f32", ".r16"};
    return std::find(kNamed.begin(), kNamed.end(), std::string_view(extension)) != kNamed.end();
}

scene::Heightfield from_named_kind(const scene::TerrainSpec& spec, const std::string& extension) {
    const fs::path& path = spec.elevation;
    std::error_code ignored;
    const bool header =
        extension != ".r16" && fs::exists(fs::path(path).replace_extension(".json"), ignored);
    if (extension == ".r16" || (extension == ".raw" && !header)) {
        if (!spec.size_m || !spec.height_m)
            throw bad(path, spec.size_m ? "terrain.height_m" : "terrain.size_m", "nothing",
                      extension == ".r16"
                          ? "the key: 16-bit posts carry neither size nor heights"
                          : "the key for 16-bit posts, or a header beside the file: NAME.json");
        return scene::read_raw16(path, *spec.size_m, *spec.height_m);
    }
    if (spec.size_m || spec.height_m)
        throw bad(path, spec.size_m ? "terrain.size_m" : "terrain.height_m", "the key",
                  "none: the file carries its own");
    return extension == ".hgt" ? scene::read_hgt(path) : scene::read_raw_elevation(path);
}

} // namespace

scene::Heightfield load_elevation(const scene::TerrainSpec& spec) {
    const GdalScope
        silence; // its libraries complain on stderr, also while coordinates are transformed
    const base::HeldWarnings held;
    const fs::path& path = spec.elevation;
    const std::string normal = fs::absolute(path).lexically_normal().string();
    if (normal.starts_with("/vsi"))
        throw bad(path, "terrain.elevation", "a virtual path of GDAL", "a file on this machine");
    const std::vector<std::byte> head =
        base::read_head(path, 16); // refuses what is not a regular file
    if (head.empty())
        throw bad(path, "cannot read elevation", "an empty file", "heights");
    if (fs::file_size(path) > kMostFileBytes)
        throw base::input_error(base::ExitCode::kOverLimit, path, 0, "file too large",
                                fmt::format("{} bytes", fs::file_size(path)),
                                fmt::format("at most {}", kMostFileBytes));
    const Format format = format_of(head);
    if (format == Format::kPng || format == Format::kExr)
        return from_picture(spec);
    if (format == Format::kJpeg)
        throw bad(path, "cannot read elevation", "JPEG, which keeps 8 bits",
                  "GeoTIFF, .hgt, 16-bit PNG or EXR");
    const std::string extension = lower_extension(path);
    if (format != Format::kTiff && is_named_kind(extension))
        return from_named_kind(spec, extension);
    return from_raster(spec);
}

} // namespace sward::assets
