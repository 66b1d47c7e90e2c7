// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <fmt/format.h>

#include "base/file.h"
#include "scene/image.h"

namespace sward::scene {

void write_ppm(const std::filesystem::path& path, const Picture& picture) {
    const auto width = static_cast<std::size_t>(picture.width),
               height = static_cast<std::size_t>(picture.height);
    if (picture.width < 1 || picture.height < 1 || picture.rgb.size() != width * height * 3)
        throw std::logic_error("write_ppm: the picture's size does not match its pixels");
    std::string file = fmt::format("P6\n{} {}\n255\n", width, height);
    file.append(reinterpret_cast<const char*>(picture.rgb.data()), picture.rgb.size());
    base::write_file_atomic(path, file);
}

} // namespace sward::scene
