// SPDX-License-Identifier: Apache-2.0
#include "assets/image_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "assets/ascii_grid.h"
#include "assets/assets.h"
#include "assets/exr_input.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/room.h"

namespace sward::assets {
namespace {

using base::ExitCode;

bool starts_with(std::span<const std::byte> head, std::initializer_list<int> magic) {
    return head.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), head.begin(),
                      [](int m, std::byte b) { return m == std::to_integer<int>(b); });
}

base::Error bad(const std::filesystem::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    base::refuse_if_starved();
    return base::input_error(ExitCode::kBadInput, path, 0, what, found, expected);
}

void check_spec(const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                std::uint64_t file_bytes, int least_side) {
    check_size(path, spec.width, spec.height, spec.nchannels, spec.pixel_bytes(true), file_bytes,
               least_side);
    if (spec.depth > 1 || spec.deep)
        throw bad(path, "kind of picture", spec.deep ? "deep samples" : "a volume",
                  "a flat picture");
    // A tile may claim to be far larger than the picture, and is read whole.
    const std::int64_t tile = std::int64_t{spec.tile_width} * spec.tile_height;
    if (tile > std::max<std::int64_t>(std::int64_t{spec.width} * spec.height, 1 << 22))
        throw base::input_error(ExitCode::kOverLimit, path, 0, "tile",
                                fmt::format("{} x {}", spec.tile_width, spec.tile_height),
                                "no more than the picture");
}

/// The picture is its display window; data that lies outside is cut off, and where there is none
/// the picture has no value.
Channel in_display_window(const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                          std::uint64_t file_bytes, int least_side, std::vector<float>& data) {
    Channel channel;
    const bool whole = spec.full_width < 1 || spec.full_height < 1;
    channel.width = whole ? spec.width : spec.full_width;
    channel.height = whole ? spec.height : spec.full_height;
    check_size(path, channel.width, channel.height, 1, sizeof(float), file_bytes, least_side);
    const std::int64_t dx = whole ? 0 : std::int64_t{spec.x} - spec.full_x,
                       dy = whole ? 0 : std::int64_t{spec.y} - spec.full_y;
    if (channel.width == spec.width && channel.height == spec.height && dx == 0 && dy == 0) {
        channel.values = std::move(data);
        return channel;
    }
    channel.values.assign(std::size_t(channel.width) * std::size_t(channel.height),
                          std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t y = std::max<std::int64_t>(0, dy);
         y < std::min<std::int64_t>(channel.height, dy + spec.height); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, dx);
             x < std::min<std::int64_t>(channel.width, dx + spec.width); ++x)
            channel.values[static_cast<std::size_t>(y * channel.width + x)] =
                data[static_cast<std::size_t>((y - dy) * spec.width + (x - dx))];
    return channel;
}

} // namespace

void check_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                int channels, std::uint64_t bytes_each, std::uint64_t file_bytes,
                std::int64_t least) {
    const std::string size = fmt::format("{} x {}", width, height);
    if (width < least || height < least)
        throw bad(path, "size", size, fmt::format("at least {} x {}", least, least));
    const auto over = [&](std::string_view what, const std::string& found,
                          const std::string& expected) {
        return base::input_error(ExitCode::kOverLimit, path, 0, what, found, expected);
    };
    if (width > kMostSide || height > kMostSide || width * height > kMostPixels)
        throw over("size", size,
                   fmt::format("at most {} a side and {} in all", kMostSide, kMostPixels));
    if (channels < 1)
        throw bad(path, "channels", std::to_string(channels), "1 to 4");
    if (channels > kMostChannels)
        throw over("channels", std::to_string(channels), fmt::format("at most {}", kMostChannels));
    const std::uint64_t decoded = static_cast<std::uint64_t>(width * height) * bytes_each;
    if (decoded > std::uint64_t{1} << 30)
        throw over("decoded size", fmt::format("{} bytes", decoded), "at most 1 GiB");
    if (decoded > kRatioFrom && decoded / kMostRatio > file_bytes)
        throw over("decoded size", fmt::format("{} bytes from {}", decoded, file_bytes),
                   fmt::format("at most {} times the file", kMostRatio));
}

Format format_of(std::span<const std::byte> head) {
    if (starts_with(head, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}))
        return Format::kPng;
    if (starts_with(head, {'I', 'I', 42, 0}) || starts_with(head, {'M', 'M', 0, 42}) ||
        starts_with(head, {'I', 'I', 43, 0}) || starts_with(head, {'M', 'M', 0, 43}))
        return Format::kTiff;
    if (starts_with(head, {0x76, 0x2F, 0x31, 0x01}))
        return Format::kExr;
    if (starts_with(head, {0xFF, 0xD8, 0xFF}))
        return Format::kJpeg;
    return Format::kUnknown;
}

Channel read_exr_channel(const std::filesystem::path& path, const ChannelRequest& request) {
    ExrInput input(path);
    const OIIO::ImageSpec& spec = input.spec();
    check_spec(path, spec, input.file_bytes(), 1);
    const int band = std::max(request.band, 1) - 1;
    if (band >= spec.nchannels)
        throw bad(path, "channels", std::to_string(spec.nchannels),
                  fmt::format("a channel {}", band + 1));
    if (request.band == 0 && spec.nchannels > 1 && spec.alpha_channel != 1)
        base::log_warning(
            fmt::format("{}: {} channels; the first is used", path.string(), spec.nchannels));
    std::vector<float> data(std::size_t(spec.width) * std::size_t(spec.height));
    input.read(band, band + 1, data.data());
    if (spec.alpha_channel >= 0 && spec.alpha_channel != band) {
        std::vector<float> alpha(data.size());
        input.read(spec.alpha_channel, spec.alpha_channel + 1, alpha.data());
        for (std::size_t i = 0; i < data.size(); ++i)
            if (alpha[i] == 0)
                data[i] = std::numeric_limits<float>::quiet_NaN();
    }
    if (input.has_more())
        base::log_warning(path.string() + ": holds several pictures; the first is used");
    return in_display_window(path, spec, input.file_bytes(), request.least_side, data);
}

scene::Image read_exr(const std::filesystem::path& path) {
    ExrInput input(path);
    const OIIO::ImageSpec& spec = input.spec();
    check_spec(path, spec, input.file_bytes(), 1);
    scene::Image image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.channelnames;
    image.texels.resize(std::size_t(spec.width) * std::size_t(spec.height) *
                        std::size_t(spec.nchannels));
    input.read(0, spec.nchannels, image.texels.data());
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
        if (attribute.type() == OIIO::TypeDesc::STRING)
            image.metadata[attribute.name().string()] = attribute.get_string();
    return image;
}

void check_rows_per_strip(const std::filesystem::path& path, std::optional<int> rows) {
    if (rows && (*rows < 1 || *rows > kMostSide))
        throw bad(path, "attribute tiff:RowsPerStrip", std::to_string(*rows),
                  fmt::format("1 to {}, or none", kMostSide));
}

void check_png_chunks(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::uint64_t size = std::filesystem::file_size(path);
    std::uint64_t at = 8; // behind the magic bytes
    std::array<unsigned char, 8> head{};
    while (at + 12 <= size && file.seekg(static_cast<std::streamoff>(at)) &&
           file.read(reinterpret_cast<char*>(head.data()), head.size())) {
        const std::uint64_t length = std::uint64_t{head[0]} << 24 | std::uint64_t{head[1]} << 16 |
                                     std::uint64_t{head[2]} << 8 | head[3];
        const std::string_view kind(reinterpret_cast<const char*>(head.data()) + 4, 4);
        if (length > size - at - 12)
            throw bad(path, fmt::format("cannot decode: chunk {}", base::printable(kind)),
                      fmt::format("{} bytes", length),
                      fmt::format("at most {}, what is left of the file", size - at - 12));
        if (kind == "IEND")
            return;
        at += length + 12;
    }
}

Channel read_channel(const std::filesystem::path& path, const ChannelRequest& request) {
    const std::vector<std::byte> head =
        base::read_head(path, 16); // refuses what is no regular file
    const Format format = format_of(head);
    if (format == Format::kUnknown && !is_ascii_grid(head))
        throw bad(path, "format", "none of them in its first bytes",
                  "PNG, TIFF, EXR, JPEG or an ASCII grid");
    if (std::filesystem::file_size(path) > kMostFileBytes)
        throw base::input_error(ExitCode::kOverLimit, path, 0, "file too large",
                                fmt::format("{} bytes", std::filesystem::file_size(path)),
                                fmt::format("at most {}", kMostFileBytes));
    if (format == Format::kPng)
        check_png_chunks(path);
    Channel channel =
        format == Format::kExr ? read_exr_channel(path, request) : read_gdal_channel(path, request);
    for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (std::isinf(channel.values[i]))
            throw bad(
                path,
                fmt::format("pixel at column {}, row {}", i % channel.width, i / channel.width),
                fmt::format("{}", channel.values[i]), "a finite number");
    return channel;
}

} // namespace sward::assets
