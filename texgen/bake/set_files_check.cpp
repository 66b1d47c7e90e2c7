// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/set_files_check.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "grass/set_files.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;
constexpr std::size_t kMaxFiles = 256;
constexpr int kMaxDepth = 32;

/// A name inside the directory: nothing that leads out of it.
bool is_plain(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.size() < 256 &&
           name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
}

json parse(const fs::path& path) {
    const std::string text = base::read_text(path, grass::kMaxSetJsonBytes);
    int depth = 0;
    for (const char c : text) {
        depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
        if (depth > kMaxDepth)
            throw base::input_error(ExitCode::kBadInput, path, 0, "JSON", "deeper nesting",
                                    fmt::format("at most {} levels", kMaxDepth));
    }
    return json::parse(text, nullptr, false);
}

FileEntry entry_of(const fs::path& path, const std::string& name, const json& value) {
    const auto refuse = [&](std::string_view what, const std::string& found,
                            std::string_view expected) {
        throw base::input_error(ExitCode::kBadInput, path, 0, what, base::printable(found),
                                expected);
    };
    if (!is_plain(name))
        refuse("files", name, "the name of a file in the set");
    if (!value.is_object() || !value.contains("bytes") || !value["bytes"].is_number_unsigned())
        refuse("files", name, "a size in bytes");
    if (!value.contains("sha256") || !value["sha256"].is_string() ||
        value["sha256"].get_ref<const std::string&>().size() != 64)
        refuse("files", name, "a SHA-256 of 64 digits");
    return {name, value["bytes"].get<std::uint64_t>(), value["sha256"].get<std::string>()};
}

bool is_our_name(const std::string& name) {
    constexpr const char* kStems[] = {"layers",  "slices",        "slabs",     "slab_fibres",
                                      "columns", "column_fibres", "correction"};
    const bool texture =
        name.ends_with(".ktx2") &&
        std::ranges::any_of(kStems, [&](const char* stem) { return name.starts_with(stem); });
    return texture || name == grass::kFarLightFile || name == grass::kFarLightPicture ||
           name == grass::kBladesFile || name == grass::kVolumeFile || name == grass::kPreviewFile;
}

bool is_unchanged(const fs::path& directory, const FileEntry& entry) {
    try {
        (void)checked_file(directory, entry);
        return true;
    } catch (const base::Error&) {
        return false;
    }
}

} // namespace

std::vector<FileEntry> listed_files(const fs::path& directory, const char* list) {
    std::error_code error;
    if (!fs::is_directory(directory, error))
        throw base::input_error(ExitCode::kIo, directory, 0, "grass set",
                                fs::exists(directory, error) ? "a file" : "no such directory",
                                "a directory that texgen wrote");
    const fs::path path = directory / list;
    if (!fs::exists(path, error))
        throw base::input_error(ExitCode::kBadInput, path, 0, "grass set", "no such file",
                                "the description of a grass set");
    const json root = parse(path);
    if (!root.is_object() || !root.contains("files") || !root["files"].is_object() ||
        root["files"].size() > kMaxFiles)
        throw base::input_error(ExitCode::kBadInput, path, 0, "JSON", "something else",
                                "a grass set's description with its files");
    std::vector<FileEntry> entries;
    for (const auto& [name, value] : root["files"].items())
        entries.push_back(entry_of(path, name, value));
    return entries;
}

std::vector<std::byte> checked_file(const fs::path& directory, const FileEntry& entry,
                                    const char* list) {
    const fs::path path = directory / entry.name;
    const auto refuse = [&](std::string_view what, const std::string& found,
                            const std::string& expected) {
        throw base::input_error(ExitCode::kBadInput, path, 0, what, found,
                                expected + " as in " + list);
    };
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        refuse("file", fs::exists(path, error) ? "no regular file" : "no such file",
               fmt::format("{} bytes", entry.bytes));
    std::vector<std::byte> bytes = base::read_file(path, kMaxFileBytes);
    if (bytes.size() != entry.bytes)
        refuse("size", fmt::format("{} bytes", bytes.size()), std::to_string(entry.bytes));
    if (const std::string found = base::sha256_hex(bytes); found != entry.sha256)
        refuse("SHA-256", found.substr(0, 16) + "...",
               base::printable(entry.sha256.substr(0, 16)) + "...");
    return bytes;
}

std::vector<std::string> foreign_files(const fs::path& directory) {
    std::vector<FileEntry> entries;
    try {
        entries = listed_files(directory);
    } catch (const base::Error&) { // none, or damaged: what looks like ours may still be replaced
    }
    // A listing alone makes no file ours: it must be the one that was written.
    std::erase_if(entries, [&](const FileEntry& entry) {
        return !is_our_name(entry.name) && !is_unchanged(directory, entry);
    });
    std::vector<std::string> names = unlisted_files(directory, entries);
    // A person's own file says more than a folder beside it.
    std::ranges::stable_partition(
        names, [&](const std::string& name) { return fs::is_regular_file(directory / name); });
    std::erase_if(names, is_our_name);
    return names;
}

std::vector<std::string> unlisted_files(const fs::path& directory,
                                        std::span<const FileEntry> entries, const char* list) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory)) {
        const std::string name = entry.path().filename().string();
        if (name != list && std::ranges::find(entries, name, &FileEntry::name) == entries.end())
            names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

} // namespace sward::texgen
