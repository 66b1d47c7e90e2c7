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
        write_linear(path,
                     view.read_aovs(aovs.empty() ? std::vector<std::string>{"color"} : aovs));
    else
        write_display(path, view.read_picture());
}

fs::path capture_screenshot(const render::ViewState& view) {
    constexpr int kMost = 9999;
    for (int number = 1; number <= kMost; ++number) {
        const fs::path path = fmt::format("sward-{:04}.{}", number, display_extension());
        std::error_code ignored;
        if (fs::exists(fs::symlink_status(path, ignored)))
            continue;
        write_display(path, view.read_picture());
        return path;
    }
    throw base::Error(
        base::ExitCode::kIo,
        fmt::format("screenshot: found sward-0001 to sward-{} taken, expected a free name", kMost));
}

} // namespace sward::app
