// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/writer.h"

#include <functional>

#include <fmt/format.h>

#include "assets/assets.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "grass/bc5.h"
#include "grass/blades_glb.h"
#include "grass/far_medium.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "texgen/bake/check_nan.h"
#include "texgen/bake/preview.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/far/far_light.h"
#include "texgen/support/output_place.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

/// A file of the set that some worker encodes.
struct Part {
    std::string name;
    std::function<std::vector<std::byte>()> encode;
};

std::vector<Part> parts_of(const grass::GrassSet& set, const BakeOptions& options) {
    std::vector<Part> parts; // the longest work first, so that two workers end together
    const auto add = [&](std::string name, const grass::TextureArray& planes) {
        parts.push_back({std::move(name), [&planes, &options] {
                             return grass::encode_ktx2(options.block ? grass::id_planes(planes)
                                                                     : planes,
                                                       options.compression);
                         }});
    };
    for (std::size_t k = 0; k < set.levels.size(); ++k) {
        const grass::FarLevel& level = set.levels[k];
        const int number = static_cast<int>(k);
        add(grass::layers_file(number), level.layers);
        if (k == 0 && options.volume && !set.blades.empty())
            parts.push_back({grass::kVolumeFile, [&set] { return encode_volume(set); }});
        add(grass::slices_file(number), level.slices);
    }
    for (std::size_t k = 0; options.block && k < set.levels.size(); ++k) {
        const grass::FarLevel& level = set.levels[k];
        const int number = static_cast<int>(k);
        for (const auto& [name, shapes] :
             {std::pair{grass::layers_shape_file(number), &level.layers_shape},
              std::pair{grass::slices_shape_file(number), &level.slices_shape}})
            parts.push_back({name, [shapes, &options] {
                                 return grass::encode_ktx2(*shapes, options.compression);
                             }});
    }
    const auto add_march = [&](std::string name, const grass::TextureArray& array) {
        parts.push_back({std::move(name), [&array, &options] {
                             return grass::encode_ktx2(array, options.compression);
                         }});
    };
    for (int k = 0; k < shared::kMarchSets; ++k) {
        add_march(grass::slabs_file(k), set.march.slabs[static_cast<std::size_t>(k)].density);
        add_march(grass::slab_fibres_file(k), set.march.slabs[static_cast<std::size_t>(k)].fibres);
    }
    add_march(grass::kColumnsFile, set.march.columns.density);
    add_march(grass::kColumnFibresFile, set.march.columns.fibres);
    parts.push_back({grass::kCorrectionFile, [&set, &options] {
                         return grass::encode_ktx2(grass::encode_correction(set.march),
                                                   options.compression);
                     }});
    if (!set.blades.empty()) // an imported volume's set is far-only
        parts.push_back({grass::kBladesFile, [&set] {
                             return grass::encode_blades(set.blades, set.variant_begin, set.side_m);
                         }});
    parts.push_back({grass::kFarLightFile, [&set, &options] {
                         return grass::encode_ktx2(grass::encode_far_light(set.far_light),
                                                   options.compression);
                     }});
    return parts;
}

FileEntry entry_of(const std::string& name, std::span<const std::byte> bytes) {
    return {name, bytes.size(), base::sha256_hex(bytes)};
}

/// Fills `folder`; returns what set.json lists.
std::vector<FileEntry> write_files(const grass::GrassSet& set, const fs::path& folder,
                                   const BakeOptions& options) {
    const std::vector<Part> parts = parts_of(set, options);
    std::vector<FileEntry> files(parts.size());
    {
        const StepTimer timer("files");
        base::Progress progress("files", parts.size());
        parallel_for(parts.size(), resolve_threads(options.threads), [&](std::size_t i, int) {
            const std::vector<std::byte> bytes = parts[i].encode();
            files[i] = entry_of(parts[i].name, bytes);
            base::write_file_atomic(folder / parts[i].name, bytes);
            progress.advance();
        });
    }
    const fs::path picture = folder / grass::kFarLightPicture;
    assets::write_exr(picture, far_light_picture(set.far_light));
    files.push_back(
        entry_of(grass::kFarLightPicture, base::read_file(picture, std::uint64_t{1} << 30)));
    if (options.preview) {
        const StepTimer timer("preview");
        const fs::path path = options.preview_file.value_or(folder / grass::kPreviewFile);
        write_preview(set, path, options.threads);
        if (!options.preview_file)
            files.push_back(
                entry_of(grass::kPreviewFile, base::read_file(path, std::uint64_t{1} << 30)));
    }
    base::write_file_atomic(folder / grass::kSetJson, set_json(set, files));
    return files;
}

} // namespace

void require_set_place(const fs::path& directory) {
    std::error_code error;
    const fs::file_status status = fs::status(directory, error);
    if (!fs::exists(status))
        return base::require_writable(directory);
    if (!fs::is_directory(status))
        throw base::input_error(base::ExitCode::kIo, directory, 0, "output", "a file",
                                "a directory for the set, or none yet");
    // The directory that stands there is removed: never one that holds something else, were it
    // beside a set.
    if (const std::vector<std::string> foreign = foreign_files(directory); !foreign.empty())
        throw base::input_error(base::ExitCode::kIo, directory, 0, "output",
                                "a file that is not the set's: " + base::printable(foreign.front()),
                                "an earlier grass set, an empty directory, or none yet");
    if (!fs::is_empty(directory, error) && !fs::is_regular_file(directory / grass::kSetJson, error))
        throw base::input_error(base::ExitCode::kIo, directory, 0, "output",
                                "a directory with other files",
                                "an earlier grass set, an empty directory, or none yet");
    fs::path beside = directory; // the new set is written beside the old one
    base::require_writable(beside += ".new");
}

std::vector<FileEntry> write_set(const grass::GrassSet& set, const Preset& preset,
                                 const fs::path& directory, const BakeOptions& options) {
    require_set_place(directory);
    if (options.check_nan)
        base::log_info(fmt::format("--checknan: {} numbers, all finite", check_finite(set)));
    base::PendingOutput pending(directory, base::PendingOutput::Kind::kDirectory);
    std::vector<FileEntry> files;
    try {
        files = write_files(set, pending.path(), options);
    } catch (const base::Error& error) {
        throw_for_place(error, pending.path(), directory);
    }
    pending.commit();
    std::uint64_t bytes = 0;
    for (const FileEntry& file : files)
        bytes += file.bytes;
    base::log_info(
        fmt::format("{}: {} blades in {} variants of {} m, canopy {:.3f} m, {} files, {:.1f} MiB",
                    directory.string(), set.blades.size(), set.variants, preset.side_m,
                    set.canopy_m, files.size() + 1, static_cast<double>(bytes) / (1 << 20)));
    return files;
}

} // namespace sward::texgen
