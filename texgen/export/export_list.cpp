// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/export_list.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

/// A file that is not as an export wrote it, or empty.
std::string foreign_to_export(const fs::path& directory) {
    std::vector<FileEntry> entries;
    try {
        entries = listed_files(directory, kExportJson);
    } catch (const base::Error&) { // no export, or a damaged one
        for (const fs::directory_entry& entry : fs::directory_iterator(directory))
            return entry.path().filename().string();
        return {};
    }
    for (const std::string& name : unlisted_files(directory, entries, kExportJson))
        return name;
    for (const FileEntry& entry : entries) {
        std::error_code error; // one that is gone is no loss
        if (!fs::exists(fs::symlink_status(directory / entry.name, error)))
            continue;
        try {
            (void)checked_file(directory, entry, kExportJson);
        } catch (const base::Error&) {
            return entry.name;
        }
    }
    return {};
}

} // namespace

void require_export_output(const fs::path& directory) {
    base::require_writable(directory, base::PendingOutput::Kind::kDirectory);
    std::error_code error;
    if (!fs::exists(directory, error))
        return;
    if (const std::string name = foreign_to_export(directory); !name.empty())
        throw base::input_error(
            base::ExitCode::kIo, directory, 0, "output",
            "a file that is no export's: " + base::printable(name),
            "an earlier export as it was written, an empty directory, or none yet");
}

std::vector<FileEntry> write_export_list(const grass::GrassSet& set, const char* target,
                                         const fs::path& folder, int threads) {
    std::vector<FileEntry> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        files.push_back({entry.path().filename().string(), 0, {}});
    std::ranges::sort(files, {}, &FileEntry::name);
    parallel_for(files.size(), resolve_threads(threads), [&](std::size_t i, int) {
        const std::vector<std::byte> bytes = base::read_file(folder / files[i].name, kMaxFileBytes);
        files[i].bytes = bytes.size();
        files[i].sha256 = base::sha256_hex(bytes);
    });
    ordered_json root = {{"format", "Sward export"},
                         {"version", 1},
                         {"for", target},
                         {"preset", set.name},
                         {"seed", set.seed},
                         {"side_m", set.side_m},
                         {"canopy_m", set.canopy_m},
                         {"variants", set.variants},
                         {"blades", set.blades.size()}};
    root["files"] = ordered_json::object();
    for (const FileEntry& file : files)
        root["files"][file.name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    base::write_file_atomic(folder / kExportJson,
                            root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                                "\n");
    return files;
}

} // namespace sward::texgen
