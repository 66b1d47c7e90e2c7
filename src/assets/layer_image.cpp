// SPDX-License-Identifier: Apache-2.0
#include "assets/layer_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "assets/exr_input.h"
#include "assets/gdal_scope.h"
#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"

namespace sward::assets {
namespace {

using base::ExitCode;
using Type = LayerImage::Type;

base::Error bad(const std::filesystem::path& path, std::string_view what, std::string_view found,
                std::string_view expected) {
    return base::input_error(ExitCode::kBadInput, path, 0, what, found, expected);
}

LayerImage read_exr(const std::filesystem::path& path) {
    ExrInput input(path);
    const OIIO::ImageSpec& spec = input.spec();
    check_size(path, spec.width, spec.height, spec.nchannels, spec.pixel_bytes(true),
               input.file_bytes(), 1);
    if (spec.depth > 1 || spec.deep)
        throw bad(path, "kind of picture", spec.deep ? "deep samples" : "a volume",
                  "a flat picture");
    if (spec.tile_width > std::max(spec.width, 2048) ||
        spec.tile_height > std::max(spec.height, 2048))
        throw base::input_error(ExitCode::kOverLimit, path, 0, "tile",
                                fmt::format("{} x {}", spec.tile_width, spec.tile_height),
                                "no more than the picture");
    LayerImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.nchannels;
    image.format = Format::kExr;
    image.names = spec.channelnames;
    image.type = spec.format == OIIO::TypeDesc::HALF ? Type::kHalf : Type::kFloat;
    image.values.resize(std::size_t(spec.width) * std::size_t(spec.height) *
                        std::size_t(spec.nchannels));
    input.read(0, spec.nchannels, image.values.data());
    if (input.has_more())
        throw bad(path, "pictures", "several in one file", "one");
    return image;
}

Type type_of(GDALRasterBandH band, const std::filesystem::path& path) {
    const GDALDataType type = GDALGetRasterDataType(band);
    if (type == GDT_Byte && GDALGetMetadataItem(band, "NBITS", "IMAGE_STRUCTURE") == nullptr &&
        !is_signed_byte(band))
        return Type::kUint8;
    if (type == GDT_UInt16)
        return Type::kUint16;
    if (type == GDT_Float32)
        return Type::kFloat;
    throw bad(path, "type of the pixels",
              type == GDT_Byte && !is_signed_byte(band) ? "less than 8 bits" : type_name(band),
              "8 or 16 bits unsigned, or 32 bits floating point");
}

LayerImage read_gdal(const std::filesystem::path& path, Format format) {
    static constexpr std::array<const char*, 3> kDrivers = {"PNG", "GTiff", nullptr};
    GdalScope gdal;
    const Dataset dataset = gdal.open(path, kDrivers.data());
    if (!dataset || GDALGetRasterCount(dataset.get()) < 1)
        throw bad(path, "cannot decode", gdal.error("broken data"), "a whole picture");
    LayerImage image;
    image.width = GDALGetRasterXSize(dataset.get());
    image.height = GDALGetRasterYSize(dataset.get());
    image.channels = GDALGetRasterCount(dataset.get());
    image.format = format;
    check_size(path, image.width, image.height, image.channels,
               sizeof(float) * std::size_t(image.channels), std::filesystem::file_size(path), 1);
    const auto channels = static_cast<std::size_t>(image.channels);
    image.values.resize(std::size_t(image.width) * std::size_t(image.height) * channels);
    std::vector<float> plane;
    for (int c = 0; c < image.channels; ++c) {
        GDALRasterBandH band = GDALGetRasterBand(dataset.get(), c + 1);
        if (GDALGetRasterColorTable(band))
            throw bad(path, "kind of picture", "a palette", "grey or colour values");
        const Type type = type_of(band, path);
        if (c > 0 && type != image.type)
            throw bad(path, "type of the pixels", "another in each channel", "one");
        image.type = type;
        gdal.read(band, path, plane);
        for (std::size_t i = 0; i < plane.size(); ++i)
            image.values[i * channels + static_cast<std::size_t>(c)] = plane[i];
    }
    return image;
}

OIIO::TypeDesc file_type(Type type) {
    switch (type) {
    case Type::kUint8:
        return OIIO::TypeDesc::UINT8;
    case Type::kUint16:
        return OIIO::TypeDesc::UINT16;
    case Type::kHalf:
        return OIIO::TypeDesc::HALF;
    case Type::kFloat:
        break;
    }
    return OIIO::TypeDesc::FLOAT;
}

/// Integers as the writer takes them; it would scale floats by the type's range.
template<typename Int> std::vector<Int> whole(const std::vector<float>& values) {
    std::vector<Int> out(values.size());
    std::ranges::transform(values, out.begin(),
                           [](float v) { return static_cast<Int>(std::lround(v)); });
    return out;
}

} // namespace

int LayerImage::alpha() const {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == "A" || names[i].ends_with(".A"))
            return static_cast<int>(i);
    return names.empty() && (channels == 2 || channels == 4) ? channels - 1 : -1;
}

LayerImage read_layer_image(const std::filesystem::path& path) {
    const Format format = format_of(base::read_head(path, 16)); // refuses what is no regular file
    if (format != Format::kPng && format != Format::kTiff && format != Format::kExr)
        throw bad(path, "format",
                  format == Format::kJpeg ? "JPEG" : "none of them in its first bytes",
                  "PNG, TIFF or EXR");
    if (std::filesystem::file_size(path) > kMostFileBytes)
        throw base::input_error(ExitCode::kOverLimit, path, 0, "file too large",
                                fmt::format("{} bytes", std::filesystem::file_size(path)),
                                fmt::format("at most {}", kMostFileBytes));
    if (format == Format::kPng)
        check_png_chunks(path);
    LayerImage image = format == Format::kExr ? read_exr(path) : read_gdal(path, format);
    const auto channels = static_cast<std::size_t>(image.channels),
               width = static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        if (!std::isfinite(image.values[i]))
            throw bad(path,
                      fmt::format("pixel at column {}, row {}", i / channels % width,
                                  i / channels / width),
                      fmt::format("{}", image.values[i]), "a finite number");
    return image;
}

std::vector<std::byte> encode_layer_image(const LayerImage& image,
                                          const std::filesystem::path& name) {
    const char* writer = image.format == Format::kPng    ? "png"
                         : image.format == Format::kTiff ? "tiff"
                                                         : "openexr";
    const auto output = OIIO::ImageOutput::create(writer);
    if (!output || !output->supports("ioproxy"))
        throw base::input_error(ExitCode::kFailure, name, 0,
                                "OpenImageIO has no writer to memory for", writer, "one");
    OIIO::ImageSpec spec(image.width, image.height, image.channels, file_type(image.type));
    if (!image.names.empty())
        spec.channelnames = image.names;
    spec.alpha_channel = image.alpha();
    spec.attribute("oiio:UnassociatedAlpha", 1); // values go out as they came in
    spec.attribute("tiff:write_exif", 0);        // it cannot write them to memory
    if (image.format == Format::kExr) {
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", ""); // else no two files are the same
    }
    OIIO::Filesystem::IOVecOutput memory;
    output->set_ioproxy(&memory);
    bool done = output->open(std::string("memory.") + writer, spec);
    if (done && image.type == Type::kUint8)
        done = output->write_image(OIIO::TypeDesc::UINT8, whole<std::uint8_t>(image.values).data());
    else if (done && image.type == Type::kUint16)
        done =
            output->write_image(OIIO::TypeDesc::UINT16, whole<std::uint16_t>(image.values).data());
    else if (done)
        done = output->write_image(OIIO::TypeDesc::FLOAT, image.values.data());
    done = output->close() && done;
    const std::string error = output->geterror() + OIIO::geterror();
    if (!done || !error.empty() || memory.buffer().empty())
        throw base::input_error(ExitCode::kFailure, name, 0, "cannot encode",
                                error.empty() ? "no reason given" : error,
                                "a picture that can be encoded");
    const std::span<const std::byte> bytes = std::as_bytes(std::span(memory.buffer()));
    return {bytes.begin(), bytes.end()};
}

} // namespace sward::assets
