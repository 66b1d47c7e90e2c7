// SPDX-License-Identifier: Apache-2.0
#include "texgen/support/output_place.h"

#include <algorithm>
#include <ranges>

namespace sward::texgen {

namespace fs = std::filesystem;

OutputParents::OutputParents(const fs::path& output) {
    std::error_code error;
    std::vector<fs::path> missing;
    const fs::path whole = fs::absolute(output).lexically_normal();
    for (fs::path p = whole.parent_path();
         p.has_relative_path() && !fs::exists(fs::symlink_status(p, error)); p = p.parent_path())
        missing.push_back(p);
    for (const fs::path& p : missing | std::views::reverse) {
        if (fs::create_directory(p, error))
            made_.push_back(p);
        else if (error) {
            take_away();
            throw base::input_error(base::ExitCode::kIo, output, 0,
                                    "cannot write: directory " + base::printable(p.string()),
                                    error.message(), "a directory, or a place to make it");
        }
    }
}

void OutputParents::take_away() {
    std::error_code ignored; // one that holds something stays
    for (const fs::path& p : made_ | std::views::reverse)
        fs::remove(p, ignored);
    made_.clear();
}

void throw_for_place(const base::Error& error, const fs::path& temporary, const fs::path& output) {
    std::string text = error.what();
    if (const std::size_t at = text.find(temporary.string()); at != std::string::npos)
        text.replace(at, temporary.string().size(), output.string());
    throw base::Error(error.code(), text);
}

} // namespace sward::texgen
