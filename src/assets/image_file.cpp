// SPDX-License-Identifier: Apache-2.0
#include "assets/image_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

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

Channel read_exr_channel(const std::filesystem::path& path, int least_side) {
    // From memory: the library sees no path, so no other file and no FIFO.
    const std::vector<std::byte> bytes = base::read_file(path, kMostFileBytes);
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create("openexr");
    if (!input)
        throw base::Error(ExitCode::kFailure,
                          "OpenImageIO has no reader for EXR: " + OIIO::geterror());
    OIIO::ImageSpec config, spec;
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto decode_error = [&] {
        const std::string error = input->geterror() + OIIO::geterror();
        return bad(path, "cannot decode", error.empty() ? "broken data" : error, "a whole picture");
    };
    if (!input->open("memory.exr", spec, config))
        throw decode_error();
    check_spec(path, spec, bytes.size(), least_side);

    Channel channel;
    channel.width = spec.width;
    channel.height = spec.height;
    channel.channels = spec.nchannels;
    channel.values.resize(std::size_t(spec.width) * spec.height);
    if (!input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, channel.values.data()))
        throw decode_error();
    if (input->seek_subimage(1, 0))
        base::log_warning(path.string() + ": holds several pictures; the first is used");
    [[maybe_unused]] const std::string no_more =
        input->geterror(); // what is never asked for is printed
    return channel;
}

Channel read_first_channel(const std::filesystem::path& path, int least_side, Palette palette) {
    const Format format = format_of(base::read_head(path, 16)); // refuses what is no regular file
    if (format == Format::kUnknown)
        throw bad(path, "format", "none of them in its first bytes", "PNG, TIFF, EXR or JPEG");
    if (std::filesystem::file_size(path) > kMostFileBytes)
        throw base::input_error(ExitCode::kOverLimit, path, 0, "file too large",
                                fmt::format("{} bytes", std::filesystem::file_size(path)),
                                fmt::format("at most {}", kMostFileBytes));
    Channel channel = format == Format::kExr ? read_exr_channel(path, least_side)
                                             : read_gdal_channel(path, least_side, palette);
    for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (!std::isfinite(channel.values[i]))
            throw bad(
                path,
                fmt::format("pixel at column {}, row {}", i % channel.width, i / channel.width),
                fmt::format("{}", channel.values[i]), "a finite number");
    return channel;
}

} // namespace sward::assets
