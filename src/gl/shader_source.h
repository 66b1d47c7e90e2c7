// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sward::gl {

/// A shader's text with every #include "..." replaced (each file once), #version and defines in
/// front, and #line directives that number the files as they stand in `files`.
struct ShaderSource {
    std::string text;
    std::vector<std::filesystem::path> files;
};

/// Where a host says that the shaders are; the environment's SWARD_SHADERS goes before. Empty:
/// nowhere.
void set_shader_directory(const std::filesystem::path& directory);
/// Where shaders live: $SWARD_SHADERS, else share/sward/shaders beside the programs, else the
/// source tree.
[[nodiscard]] std::filesystem::path shader_directory();

/// Expands `path` (below shader_directory()). Throws Error(kNoGpu) naming file:line of the include
/// that is missing.
[[nodiscard]] ShaderSource expand_shader(const std::filesystem::path& path,
                                         const std::vector<std::string>& defines);

/// A driver's log with "0:12" or "0(12)" turned into "file:12".
[[nodiscard]] std::string readable_log(const std::string& log, const ShaderSource& source);

} // namespace sward::gl
