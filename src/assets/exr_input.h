// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/error.h"

namespace sward::assets {

/// An EXR file that is open, read from memory: the library sees no path, so no other file and no
/// FIFO.
class ExrInput {
public:
    /// Throws base::Error: kIo, kOverLimit for a file above kMostFileBytes, kBadInput for what is
    /// no EXR.
    explicit ExrInput(const std::filesystem::path& path);
    [[nodiscard]] const OIIO::ImageSpec& spec() const { return spec_; }
    [[nodiscard]] std::size_t file_bytes() const { return bytes_.size(); }
    /// Channels `first` to `end`, floats, into room for all of them; of one channel of whole
    /// numbers, these. Throws base::Error(kBadInput) for broken data.
    void read(int first, int end, float* into);
    /// Is there a second picture in the file?
    [[nodiscard]] bool has_more();

private:
    [[nodiscard]] base::Error decode_error() const;
    std::filesystem::path path_;
    std::vector<std::byte> bytes_;
    OIIO::Filesystem::IOMemReader memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
    OIIO::ImageSpec spec_;
};

} // namespace sward::assets
