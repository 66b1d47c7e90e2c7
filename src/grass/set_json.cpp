// SPDX-License-Identifier: Apache-2.0
#include "grass/set_json.h"

#include "base/file.h"
#include "base/hash.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"

namespace sward::grass {

using base::ExitCode;
namespace fs = std::filesystem;

namespace {
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;
} // namespace

SetJson::SetJson(const fs::path& path) : path_(path) {
    const std::string text = base::read_text(path, kMaxSetJsonBytes);
    check_depth(text);
    root_ = nlohmann::json::parse(text, nullptr, false);
    if (!root_.is_object())
        refuse("JSON", "something else", "a grass set's description");
}

void SetJson::check_depth(const std::string& text) const {
    int depth = 0;
    for (const char c : text) {
        depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
        if (depth > 32)
            refuse("JSON", "deeper nesting", "at most 32 levels");
    }
}

std::vector<std::byte> verified_file(const SetJson& set, const fs::path& directory,
                                     const std::string& name) {
    const nlohmann::json& entry = set.at(set.at(set.root(), "files"), name.c_str());
    const auto size = static_cast<std::uint64_t>(
        set.number(entry, "bytes", 0, static_cast<double>(kMaxFileBytes)));
    const std::string expected = set.text(entry, "sha256");
    std::vector<std::byte> bytes = base::read_file(directory / name, kMaxFileBytes);
    if (bytes.size() != size)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "size",
                                fmt::format("{} bytes", bytes.size()),
                                fmt::format("{} as in {}", size, kSetJson));
    const std::string found = base::sha256_hex(bytes);
    if (found != expected)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "SHA-256",
                                found.substr(0, 16) + "...",
                                base::printable(expected.substr(0, 16)) + "... as in " + kSetJson);
    return bytes;
}

TextureArray read_array(const SetJson& set, const fs::path& directory, const std::string& name,
                        int images, TexelFormat format) {
    TextureArray array = decode_ktx2(verified_file(set, directory, name), directory / name);
    if (array.plain)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "shape",
                                "a single texture", "a 2D array");
    if (array.layers != images)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "images",
                                std::to_string(array.layers), std::to_string(images));
    if (array.format != format)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "format", "another",
                                format == TexelFormat::kBc5 ? "BC5 UNORM" : "RGBA8 UNORM");
    return array;
}

} // namespace sward::grass
