// SPDX-License-Identifier: Apache-2.0
// Every file against its hash, then every number against its limit. Nothing is parsed before its
// hash is right.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "grass/grass_set.h"
#include "grass/set_files.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/cli/commands.h"
#include "texgen/report/report.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {
namespace {

using base::ExitCode;

constexpr std::uint64_t kSoonBytes = std::uint64_t{32}
                                     << 20; ///< a set that is checked in a second needs no progress

/// Throws the first thing that is wrong.
std::vector<FileEntry> verify(const std::filesystem::path& directory) {
    std::vector<FileEntry> entries = listed_files(directory);
    std::uint64_t total = 0;
    for (const FileEntry& entry : entries)
        total += entry.bytes;
    base::Progress progress("checking", total > kSoonBytes ? 2 * total : 0); // hashes, then numbers
    for (const FileEntry& entry : entries) {
        const std::vector<std::byte> bytes = checked_file(directory, entry);
        base::log_debug(fmt::format("{}: {} bytes, SHA-256 as listed", entry.name, bytes.size()));
        if (entry.name == grass::kVolumeFile &&
            inspect_volume(bytes, directory / entry.name).active_voxels == 0)
            throw base::input_error(ExitCode::kBadInput, directory / entry.name, 0, "density",
                                    "no voxel", "blades");
        progress.advance(entry.bytes);
    }
    (void)grass::read_grass_set(directory);
    progress.advance(total);
    for (const std::string& name : unlisted_files(directory, entries))
        base::log_warning(fmt::format("{}: not a file of the set",
                                      base::printable((directory / name).string(), 300)));
    return entries;
}

} // namespace

int run_verify(const VerifyOptions& options) {
    base::set_verbosity(options.verbosity);
    nlohmann::ordered_json report = {{"set", options.input.string()}, {"ok", true}};
    try {
        const std::vector<FileEntry> entries = verify(options.input);
        std::uint64_t bytes = 0;
        for (const FileEntry& entry : entries)
            bytes += entry.bytes;
        report["files"] = entries.size();
        report["bytes"] = bytes;
        base::log_info(fmt::format("{}: whole, {} files, {} bytes", options.input.string(),
                                   entries.size(), bytes));
    } catch (const base::Error& error) {
        if (!options.json)
            throw;
        base::log_error(error.what());
        report["ok"] = false;
        report["error"] = error.what();
        print_result(report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
        return static_cast<int>(error.code());
    }
    if (options.json)
        print_result(report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return 0;
}

} // namespace sward::texgen
