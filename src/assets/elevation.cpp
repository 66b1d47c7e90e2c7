// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/gdal_raster.h"
#include "assets/image_file.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

base::Error bad(const fs::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
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

void refuse_voids_only(const fs::path& path, const std::vector<float>& metres) {
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
    Channel channel = read_first_channel(spec.elevation, 2);
    if (channel.full_scale > 0 && channel.full_scale < 65535)
        throw bad(spec.elevation, "bits a channel", "8",
                  "16, or floating point: 8 bits make steps");
    if (channel.full_scale > 0 && !spec.height_m)
        throw bad(spec.elevation, "terrain.height_m", "nothing",
                  "[metres at 0, metres at full scale]");
    if (channel.full_scale == 0 && spec.height_m)
        throw bad(spec.elevation, "terrain.height_m", "the key",
                  "none: floating point is metres already");
    if (channel.channels > 1)
        base::log_warning(fmt::format("{}: {} channels; the first is the height",
                                      spec.elevation.string(), channel.channels));
    apply_height_range(spec, channel.full_scale, channel.values);
    for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (!(std::abs(channel.values[i]) <= 1e5f))
            throw bad(
                spec.elevation,
                fmt::format("height at column {}, row {}", i % channel.width, i / channel.width),
                fmt::format("{} m", channel.values[i]), "-100000 to 100000 m");
    return spread(spec, channel.width, channel.height, std::move(channel.values));
}

scene::Heightfield from_raster(const scene::TerrainSpec& spec) {
    Raster raster = read_gdal_raster(spec.elevation);
    if (spec.height_m && (raster.full_scale == 0 || raster.has_unit))
        throw bad(spec.elevation, "terrain.height_m", "the key",
                  "none: only unsigned integers without a unit take it");
    apply_height_range(spec, raster.full_scale, raster.values);
    if (const std::size_t filled = scene::fill_voids(raster.width, raster.height, raster.values))
        base::log_debug(fmt::format("{}: filled {} voids", spec.elevation.string(), filled));
    refuse_voids_only(spec.elevation, raster.values);
    if (!raster.placement)
        return spread(spec, raster.width, raster.height, std::move(raster.values));
    if (spec.size_m)
        throw bad(spec.elevation, "terrain.size_m", "the key",
                  "none: the file carries its own place and size");
    return to_local_grid(raster, spec.elevation);
}

} // namespace

scene::Heightfield load_elevation(const scene::TerrainSpec& spec) {
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
    const bool own_size = extension == ".hgt" || extension == ".raw" || extension == ".f32";
    if (format != Format::kTiff && own_size) {
        if (spec.size_m || spec.height_m)
            throw bad(path, spec.size_m ? "terrain.size_m" : "terrain.height_m", "the key",
                      "none: the file carries its own");
        return extension == ".hgt" ? scene::read_hgt(path) : scene::read_raw_elevation(path);
    }
    return from_raster(spec);
}

} // namespace sward::assets
