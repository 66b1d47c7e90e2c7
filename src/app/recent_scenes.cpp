// SPDX-License-Identifier: Apache-2.0
#include "app/recent_scenes.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFileLimit = 1u << 16;

bool fits_a_line(std::string_view path) {
    return path.starts_with('/') && std::none_of(path.begin(), path.end(), [](char c) {
               return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
           });
}

} // namespace

std::vector<fs::path> with_recent(std::vector<fs::path> list, const fs::path& scene) {
    std::erase(list, scene);
    list.insert(list.begin(), scene);
    list.resize(std::min(list.size(), kMostRecent));
    return list;
}

std::vector<fs::path> parse_recent(std::string_view text) {
    std::vector<fs::path> list;
    while (!text.empty() && list.size() < kMostRecent) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        if (fits_a_line(line) && std::find(list.begin(), list.end(), fs::path(line)) == list.end())
            list.emplace_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return list;
}

std::string format_recent(const std::vector<fs::path>& list) {
    std::string text;
    for (const fs::path& scene : list)
        if (fits_a_line(scene.native()))
            text += scene.native() + "\n";
    return text;
}

std::vector<fs::path> read_recent(const fs::path& file) {
    try {
        return file.empty() ? std::vector<fs::path>{}
                            : parse_recent(base::read_text(file, kFileLimit));
    } catch (const base::Error&) { // there is none yet, most often
        return {};
    }
}

void note_recent(const fs::path& file, const fs::path& scene) {
    if (file.empty())
        return;
    try {
        std::error_code error;
        fs::create_directories(file.parent_path(), error);
        base::write_file_atomic(
            file,
            format_recent(with_recent(read_recent(file), fs::absolute(scene).lexically_normal())));
    } catch (const base::Error& error) {
        base::log_debug(std::string("recent scenes: ") + error.what());
    }
}

} // namespace sward::app
