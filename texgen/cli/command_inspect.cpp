// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/cli/commands.h"
#include "texgen/report/report.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;

std::string dump(const ordered_json& root) {
    return root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

const char* format_name(grass::TexelFormat format) {
    switch (format) {
    case grass::TexelFormat::kRgba8:
        return "RGBA8";
    case grass::TexelFormat::kRgba16f:
        return "RGBA16F";
    case grass::TexelFormat::kRgba32f:
        return "RGBA32F";
    case grass::TexelFormat::kBc5:
        return "BC5";
    case grass::TexelFormat::kRgba8Srgb:
        return "RGBA8 sRGB";
    }
    return "";
}

std::string inspect_texture(const fs::path& path, bool json) {
    const std::vector<std::byte> bytes = base::read_file(path, kMaxFileBytes);
    const grass::TextureArray array = grass::decode_ktx2(bytes, path);
    std::uint64_t unpacked = 0;
    for (const std::vector<std::uint8_t>& mip : array.mips)
        unpacked += mip.size();
    if (json)
        return dump({{"file", path.string()},
                     {"format", format_name(array.format)},
                     {"width", array.width},
                     {"height", array.height},
                     {"images", array.layers},
                     {"mips", array.mips.size()},
                     {"bytes", bytes.size()},
                     {"gpu_bytes", unpacked}});
    return fmt::format("{}: {} images of {} x {} texels, {}, {} mips, {} on disk, {} on the GPU\n",
                       path.string(), array.layers, array.width, array.height,
                       format_name(array.format), array.mips.size(), readable_bytes(bytes.size()),
                       readable_bytes(unpacked));
}

/// The bytes of a volume. Where a set.json beside it lists it, its hash must be right before
/// anything parses it.
std::vector<std::byte> volume_bytes(const fs::path& path) {
    std::error_code error;
    fs::path folder = path.parent_path();
    if (folder.empty())
        folder = ".";
    if (fs::exists(folder / grass::kSetJson, error))
        for (const FileEntry& entry : listed_files(folder))
            if (entry.name == path.filename())
                return checked_file(folder, entry);
    return read_vdb_file(path);
}

std::string inspect_vdb(const fs::path& path, bool json) {
    const std::vector<std::byte> bytes = volume_bytes(path);
    const VolumeInfo info = inspect_volume(bytes, path);
    if (json)
        return dump({{"file", path.string()},
                     {"grids", info.grids},
                     {"voxel_m", info.voxel_m},
                     {"active_voxels", info.active_voxels},
                     {"density_sum", info.density_sum},
                     {"bytes", bytes.size()}});
    return fmt::format("{}: grids {}; {} active voxels of {:.2f} mm, {} on disk\n", path.string(),
                       fmt::join(info.grids, ", "), info.active_voxels, 1000 * info.voxel_m,
                       readable_bytes(bytes.size()));
}

std::string inspect_set(const fs::path& path, bool json) {
    const std::vector<FileEntry> files = listed_files(path);
    const SetReport report = report_of(grass::read_grass_set(path), path.string(), files);
    return json ? report_json(report) : report_text(report);
}

} // namespace

int run_inspect(const InspectOptions& options) {
    base::set_verbosity(options.verbosity);
    std::error_code error;
    const fs::path extension = options.input.extension();
    const bool directory = fs::is_directory(options.input, error);
    if (!directory && extension != ".ktx2" && extension != ".vdb" &&
        fs::exists(options.input, error))
        throw base::input_error(ExitCode::kBadInput, options.input, 0, "kind of file",
                                extension.empty() ? "no extension" : extension.string(),
                                "a grass set's directory, a .ktx2 or a .vdb");
    const std::string text = directory || extension.empty()
                                 ? inspect_set(options.input, options.json)
                             : extension == ".vdb"  ? inspect_vdb(options.input, options.json)
                             : extension == ".ktx2" ? inspect_texture(options.input, options.json)
                                                    : inspect_set(options.input, options.json);
    print_result(text);
    return 0;
}

} // namespace sward::texgen
