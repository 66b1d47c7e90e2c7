// SPDX-License-Identifier: Apache-2.0
#include "gl/shader_source.h"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"

namespace sward::gl {

namespace fs = std::filesystem;
using base::Error;
using base::ExitCode;

namespace {

constexpr std::uint64_t kMaxShaderBytes = 1u << 20;
fs::path g_given; // by a host; the context's thread only

void expand(ShaderSource& out, const fs::path& root, const fs::path& name,
            const std::string& wanted_by) {
    if (std::find(out.files.begin(), out.files.end(), name) != out.files.end()) {
        return; // every file once: headers need no guards of their own, and cycles end here
    }
    std::string text;
    try {
        text = base::read_text(root / name, kMaxShaderBytes);
    } catch (const Error& error) {
        throw Error(ExitCode::kNoGpu,
                    fmt::format("{}: shader: {}", wanted_by.empty() ? name.string() : wanted_by,
                                error.what()));
    }
    const std::size_t file_number = out.files.size();
    out.files.push_back(name);
    out.text += fmt::format("#line 1 {}\n", file_number);
    static const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)")re");
    std::istringstream lines(text);
    std::string line;
    bool cpp_only = false; // the preprocessor would skip these, but their includes must not be read
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (line == "#ifdef __cplusplus") {
            cpp_only = true;
        } else if (cpp_only && (line == "#endif" || line == "#else")) {
            cpp_only = false;
        }
        if (!cpp_only && std::regex_search(line, match, include)) {
            expand(out, root, match[1].str(), fmt::format("{}:{}", name.string(), number));
            out.text += fmt::format("#line {} {}\n", number + 1, file_number);
        } else {
            out.text += line + "\n";
        }
    }
}

} // namespace

void set_shader_directory(const fs::path& directory) {
    g_given = directory;
}

fs::path shader_directory() {
    if (const char* chosen = std::getenv("SWARD_SHADERS"); chosen && *chosen) {
        return chosen;
    }
    if (!g_given.empty()) {
        return g_given;
    }
    const fs::path installed = base::executable_directory() / ".." / "share" / "sward" / "shaders";
    std::error_code ignored;
    return fs::is_directory(installed, ignored) ? installed : fs::path(SWARD_SHADER_SOURCE_DIR);
}

ShaderSource expand_shader(const fs::path& path, const std::vector<std::string>& defines) {
    ShaderSource out;
    out.text = "#version 450 core\n";
    for (const std::string& define : defines) {
        out.text += "#define " + define + "\n";
    }
    expand(out, shader_directory(), path, "");
    return out;
}

std::string readable_log(const std::string& log, const ShaderSource& source) {
    // Mesa: "0:12(5): error", NVIDIA: "0(12) : error".
    static const std::regex place(R"((^|\n)(?:ERROR: |WARNING: )?(\d+)(?::(\d+)|\((\d+)\)))");
    std::string out;
    auto from = log.cbegin();
    for (std::sregex_iterator it(log.cbegin(), log.cend(), place), end; it != end; ++it) {
        const auto& match = *it;
        const std::size_t file = std::stoul(match[2].str());
        out.append(from, match[0].first);
        const std::string line = match[3].matched ? match[3].str() : match[4].str();
        out += match[1].str() +
               (file < source.files.size() ? source.files[file].string() : match[2].str()) + ":" +
               line;
        from = match[0].second;
    }
    out.append(from, log.cend());
    return out;
}

} // namespace sward::gl
