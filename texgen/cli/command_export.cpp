// SPDX-License-Identifier: Apache-2.0
// `texgen export`: a set for other engines.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "grass/blades_glb.h"
#include "grass/set_files.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/cli/commands.h"
#include "texgen/export/blade_mesh.h"
#include "texgen/export/export_list.h"
#include "texgen/export/export_mesh.h"
#include "texgen/export/export_textures.h"
#include "texgen/report/report.h"
#include "texgen/support/output_place.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

const char* name_of(ExportTarget target) {
    return target == ExportTarget::kGltf       ? "gltf"
           : target == ExportTarget::kTextures ? "textures"
                                               : "blender";
}

/// An export in the set's own directory would make it no set.
void refuse_inside_set(const ExportCommandOptions& o) {
    std::error_code ignored;
    const fs::path set = fs::weakly_canonical(o.input, ignored),
                   place = fs::weakly_canonical(o.output, ignored);
    if (place == set || place.parent_path() == set)
        throw base::input_error(base::ExitCode::kIo, o.output, 0, "--output",
                                place == set ? "the set itself" : "a place inside the set",
                                "a place outside of it");
}

void require_blades(const grass::GrassSet& set, const fs::path& directory) {
    if (set.blades.empty())
        throw base::input_error(base::ExitCode::kBadInput, directory, 0, "blades",
                                "none (a far-only set)", "blades; --for textures needs none");
}

void write_for_blender(const grass::GrassSet& set, const ExportCommandOptions& o,
                       const fs::path& folder) {
    base::write_file_atomic(folder / kMeshFile, encode_blade_meshes(set, 1, o.threads));
    base::write_file_atomic(folder / grass::kBladesFile,
                            grass::encode_blades(set.blades, set.variant_begin, set.side_m));
    const std::vector<FileEntry> files = listed_files(o.input);
    const auto volume = std::ranges::find(files, grass::kVolumeFile, &FileEntry::name);
    if (volume != files.end())
        base::write_file_atomic(folder / grass::kVolumeFile, checked_file(o.input, *volume));
    else
        base::log_warning(fmt::format("{}: no {}: meshes and points alone are exported",
                                      base::printable(o.input.string(), 300), grass::kVolumeFile));
}

void write_files(const grass::GrassSet& set, const ExportCommandOptions& o,
                 const fs::path& folder) {
    if (o.target == ExportTarget::kTextures)
        return write_textures(
            set, o.input, folder,
            {.threads = o.threads, .compression = o.compression.zstd_level, .atlases = o.atlases});
    if (o.target == ExportTarget::kBlender)
        return write_for_blender(set, o, folder);
    base::write_file_atomic(
        folder / kMeshFile,
        encode_blade_meshes(set, static_cast<int>(std::size(kMeshLods)), o.threads));
}

void report(const grass::GrassSet& set, const ExportCommandOptions& o,
            const std::vector<FileEntry>& files) {
    std::uint64_t bytes = 0;
    nlohmann::ordered_json root = {{"export", o.output.string()},
                                   {"set", o.input.string()},
                                   {"for", name_of(o.target)},
                                   {"preset", set.name}};
    for (const FileEntry& file : files) {
        bytes += file.bytes;
        root["files"][file.name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    }
    base::log_info(fmt::format("{}: {} files for {}, {}", o.output.string(), files.size() + 1,
                               name_of(o.target), readable_bytes(bytes)));
    if (o.json)
        print_result(root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

} // namespace

int run_export(const ExportCommandOptions& o) {
    base::set_verbosity(o.verbosity);
    (void)listed_files(o.input); // is there a set at all: before its place is made
    refuse_inside_set(o);
    const OutputParents parents(o.output);
    require_export_output(o.output);
    const grass::GrassSet set = grass::read_grass_set(o.input);
    if (o.target != ExportTarget::kTextures)
        require_blades(set, o.input);
    base::PendingOutput pending(o.output, base::PendingOutput::Kind::kDirectory);
    std::vector<FileEntry> files;
    try {
        write_files(set, o, pending.path());
        files = write_export_list(set, name_of(o.target), pending.path(), o.threads);
    } catch (const base::Error& error) {
        throw_for_place(error, pending.path(), o.output);
    }
    pending.commit();
    report(set, o, files);
    return 0;
}

} // namespace sward::texgen
