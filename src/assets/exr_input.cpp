// SPDX-License-Identifier: Apache-2.0
#include "assets/exr_input.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "assets/image_file.h"
#include "assets/limits.h"
#include "base/file.h"

namespace sward::assets {

ExrInput::ExrInput(const std::filesystem::path& path)
    : path_(path), bytes_(base::read_file(path, kMostFileBytes)),
      memory_(bytes_.data(), bytes_.size()), input_(OIIO::ImageInput::create("openexr")) {
    if (!input_)
        throw base::Error(base::ExitCode::kFailure,
                          "OpenImageIO has no reader for EXR: " + OIIO::geterror());
    OIIO::ImageSpec config;
    void* proxy = &memory_;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!input_->open("memory.exr", spec_, config))
        throw decode_error();
    // OpenEXR's attributes come by the library's names for any format: one that makes no sense
    // would be used.
    const OIIO::ParamValue* rows = spec_.find_attribute("tiff:RowsPerStrip");
    check_rows_per_strip(path, rows ? std::optional(rows->get_int()) : std::nullopt);
}

base::Error ExrInput::decode_error() const {
    const std::string error = (input_ ? input_->geterror() : std::string()) + OIIO::geterror();
    return base::input_error(base::ExitCode::kBadInput, path_, 0, "cannot decode",
                             error.empty() ? "broken data" : error, "a whole picture");
}

void ExrInput::read(int first, int end, float* into) {
    if (end == first + 1 && spec_.channelformat(first) ==
                                OIIO::TypeDesc::UINT32) { // the library would scale numbers to 0..1
        std::vector<std::uint32_t> numbers(std::size_t(spec_.width) * std::size_t(spec_.height));
        if (!input_->read_image(0, 0, first, end, OIIO::TypeDesc::UINT32, numbers.data()))
            throw decode_error();
        std::transform(numbers.begin(), numbers.end(), into,
                       [](std::uint32_t n) { return static_cast<float>(n); });
        return;
    }
    if (!input_->read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, into))
        throw decode_error();
}

bool ExrInput::has_more() {
    const bool more = input_->seek_subimage(1, 0);
    [[maybe_unused]] const std::string no_more =
        input_->geterror(); // what is never asked for is printed
    return more;
}

} // namespace sward::assets
