// SPDX-License-Identifier: Apache-2.0
#include "app/capture.h"

#include <fmt/format.h>

#include "app/io.h"
#include "base/error.h"

namespace sward::app {

namespace fs = std::filesystem;

void capture(const render::ViewState& view, const fs::path& path,
             const std::vector<std::string>& aovs) {
    if (is_linear(path))
        write_linear(path, view.read_aovs(aovs.empty() ? std::vector<std::string>{"color"} : aovs));
    else
        write_display(path, view.read_picture());
}

namespace {

constexpr int kMost = 9999;

base::Error no_free_name(const char* what, const char* stem) {
    return {base::ExitCode::kIo,
            fmt::format("{}: found {}-0001 to {}-{} taken, expected a free name", what, stem, stem,
                        kMost)};
}

bool is_taken(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

} // namespace

fs::path capture_screenshot(const render::ViewState& view) {
    for (int number = 1; number <= kMost; ++number) {
        const fs::path path = fmt::format("sward-{:04}.{}", number, display_extension());
        if (is_taken(path))
            continue;
        write_display(path, view.read_picture());
        return path;
    }
    throw no_free_name("screenshot", "sward");
}

PictureSequence::PictureSequence() {
    for (int number = 1; number <= kMost; ++number) {
        const fs::path path = fmt::format("sward-seq-{:04}", number);
        std::error_code error;
        if (is_taken(path))
            continue;
        if (!fs::create_directory(path, error) && error)
            throw base::input_error(base::ExitCode::kIo, path, 0,
                                    "cannot make the folder of a sequence", error.message(),
                                    "a writable working directory");
        folder_ = path;
        return;
    }
    throw no_free_name("sequence", "sward-seq");
}

void PictureSequence::add(const render::ViewState& view) {
    write_display(folder_ / fmt::format("{:05}.{}", count_, display_extension()),
                  view.read_picture());
    ++count_;
}

} // namespace sward::app
