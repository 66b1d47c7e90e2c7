// SPDX-License-Identifier: Apache-2.0
// Pictures are encoded into memory and written by our own code: OpenImageIO reports success on a
// full disk.
#include <algorithm>

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/gdal_raster.h"
#include "base/error.h"
#include "base/file.h"

namespace sward::assets {
namespace {

base::Error failure(const std::filesystem::path& path, std::string_view what,
                    std::string_view found) {
    return base::input_error(base::ExitCode::kFailure, path, 0, what, found,
                             "a picture that can be encoded");
}

void encode_and_write(const std::filesystem::path& path, const char* writer,
                      const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
    base::require_writable(path); // before the work of encoding
    const auto output = OIIO::ImageOutput::create(writer);
    if (!output || !output->supports("ioproxy"))
        throw failure(path, "OpenImageIO has no writer to memory for", writer);
    OIIO::Filesystem::IOVecOutput memory;
    output->set_ioproxy(&memory);
    const bool done = output->open(std::string("memory.") + writer, spec) &&
                      output->write_image(type, pixels) && output->close();
    const std::string error = output->geterror() + OIIO::geterror();
    if (!done || !error.empty() || memory.buffer().empty())
        throw failure(path, "cannot encode", error.empty() ? "no reason given" : error);
    base::write_file_atomic(path, std::as_bytes(std::span(memory.buffer())));
}

bool is_colour(const std::string& channel) {
    return channel == "R" || channel == "G" || channel == "B" || channel == "A";
}

} // namespace

void write_png(const std::filesystem::path& path, const scene::Picture& picture) {
    const auto pixels =
        std::size_t(std::max(picture.width, 0)) * std::size_t(std::max(picture.height, 0));
    if (pixels == 0 || picture.rgb.size() != pixels * 3)
        throw failure(path, "picture",
                      fmt::format("{} bytes for {} pixels", picture.rgb.size(), pixels));
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    encode_and_write(path, "png", spec, OIIO::TypeDesc::UINT8, picture.rgb.data());
}

void write_png(const std::filesystem::path& path, const ByteImage& image) {
    const auto pixels =
        std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
    if (pixels == 0 || image.channels < 1 || image.channels > 4 ||
        image.values.size() != pixels * static_cast<std::size_t>(image.channels))
        throw failure(path, "picture",
                      fmt::format("{} bytes for {} pixels of {} channels", image.values.size(),
                                  pixels, image.channels));
    OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", image.colour ? "sRGB" : "Linear");
    spec.attribute("oiio:UnassociatedAlpha", 1); // written as it is, not divided by alpha
    encode_and_write(path, "png", spec, OIIO::TypeDesc::UINT8, image.values.data());
}

void write_exr(const std::filesystem::path& path, const scene::Image& image) {
    const auto pixels =
        std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
    const std::size_t channels = image.channels.size();
    if (pixels == 0 || channels == 0 || image.texels.size() != pixels * channels)
        throw failure(path, "picture",
                      fmt::format("{} values for {} pixels of {} channels", image.texels.size(),
                                  pixels, channels));
    OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channels;
    spec.alpha_channel = -1;
    for (std::size_t c = 0; c < channels; ++c) {
        spec.channelformats.push_back(is_colour(image.channels[c]) ? OIIO::TypeDesc::HALF
                                                                   : OIIO::TypeDesc::FLOAT);
        if (image.channels[c] == "A")
            spec.alpha_channel = static_cast<int>(c);
    }
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("DateTime",
                   ""); // else the writer puts the time of day in, and no two files are the same
    for (const auto& [key, value] : image.metadata)
        spec.attribute(key, value);

    // A sun in the picture may pass the largest half; infinity would spread in every filter that
    // reads it.
    std::vector<float> texels = image.texels;
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (is_colour(image.channels[i % channels]))
            texels[i] = std::clamp(texels[i], -float(HALF_MAX), float(HALF_MAX));
    encode_and_write(path, "openexr", spec, OIIO::TypeDesc::FLOAT, texels.data());
}

std::string library_versions() {
    return fmt::format("OpenImageIO {}, {}", OIIO_VERSION_STRING, gdal_versions());
}

} // namespace sward::assets
