// SPDX-License-Identifier: Apache-2.0
// `texgen import`: a volume from another program becomes a far-only set.
#include <algorithm>
#include <cctype>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "texgen/bake/writer.h"
#include "texgen/cli/commands.h"
#include "texgen/import/import.h"
#include "texgen/import/import_stack.h"
#include "texgen/seam/seam.h"
#include "texgen/support/output_place.h"
#include "texgen/vdb/vdb_file.h"

namespace sward::texgen {
namespace {

JointReport joint_of(const Volume& volume) {
    std::vector<glm::ivec3> at;
    at.reserve(volume.at.size());
    for (const VoxelPlace& p : volume.at)
        at.emplace_back(p.x, p.y, p.z);
    return measure_cells({at, volume.density, 1, {0, 0, 0}, volume.cells, {}});
}

/// A name that a set may carry, from the file's.
std::string plain_name(const std::filesystem::path& file) {
    std::string name = file.stem().string().substr(0, 64);
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_')
            c = '-';
    return name.empty() ? "imported" : name;
}

/// An option that the other kind of input takes is not passed over in silence.
void refuse_foreign_options(const ImportOptions& o, bool stack) {
    const ImportOptions usual;
    const auto refuse = [&](bool given, const char* option, const char* of) {
        if (given)
            throw base::Error(base::ExitCode::kUsage,
                              fmt::format("{}: found with {}, expected with {}", option,
                                          stack ? "a stack of pictures" : "a volume", of));
    };
    if (stack) {
        refuse(o.z_up, "--up", "a .vdb");
        refuse(o.scale != usual.scale, "--scale", "a .vdb; a stack has --side");
        refuse(o.period_m > 0, "--period", "a .vdb; a stack has --side");
    } else {
        refuse(o.side_m > 0, "--side", "a directory of pictures; a volume has --scale");
        refuse(o.canopy_m > 0, "--canopy", "a directory of pictures; a volume has --scale");
    }
}

Volume read_input(const ImportOptions& o) {
    std::error_code error;
    const bool stack = std::filesystem::is_directory(o.input, error);
    refuse_foreign_options(o, stack);
    if (stack)
        return read_stack_volume(o.input, o.side_m, o.canopy_m);
    const std::vector<std::byte> bytes = read_vdb_file(o.input);
    return VdbFile(bytes, o.input)
        .read_volume({.z_up = o.z_up, .scale = o.scale, .period_m = o.period_m});
}

/// The input as a volume, made periodic if that is asked for.
Volume load(const ImportOptions& options) {
    Volume volume = read_input(options);
    if (options.seam)
        return seam_volume(volume,
                           options.cut < 1 ? SeamCut{.share = options.cut}
                                           : SeamCut{.texels = static_cast<int>(options.cut)},
                           options.input);
    return volume;
}

} // namespace

int run_import(const ImportOptions& options) {
    base::set_verbosity(options.verbosity);
    if (options.seam && !(options.cut > 0))
        throw base::Error(base::ExitCode::kUsage,
                          "--cut: found 0, expected a share of the side below 1, or texels from 3");
    const OutputParents parents(options.output);
    require_set_place(options.output);
    const Volume volume = load(options);
    const JointReport joint = volume.cells.x == volume.cells.z ? joint_of(volume) : JointReport{};
    if (joint.ratio() > kMostJointRatio)
        base::log_warning(fmt::format(
            "{}: the joint's gradient is {}: the volume is not periodic{}", options.input.string(),
            joint.words(), options.seam ? "; try another --cut" : ", --seam makes it so"));
    ImportQuery query{.name = options.name,
                      .density = options.density,
                      .size = options.size,
                      .layers = options.layers,
                      .slices = options.slices,
                      .levels = options.levels,
                      .far_rays = options.far_rays,
                      .threads = options.threads};
    if (query.name.empty())
        query.name = volume.preset.empty() ? plain_name(options.input) : volume.preset;
    grass::GrassSet set = import_volume(volume, query, options.input);
    Preset preset;
    preset.name = set.name;
    preset.side_m = set.side_m;
    BakeOptions bake;
    bake.threads = options.threads;
    bake.volume = false;
    bake.preview = options.preview;
    bake.compression = options.compression.zstd_level;
    bake.block = options.compression.block;
    if (bake.block)
        compress_shapes(set, options.threads);
    write_set(set, preset, options.output, bake);
    if (options.json)
        fmt::print("{}\n", nlohmann::ordered_json({{"set", options.output.string()},
                                                   {"name", set.name},
                                                   {"side_m", set.side_m},
                                                   {"canopy_m", set.canopy_m},
                                                   {"voxels", volume.at.size()},
                                                   {"joint", std::min(joint.ratio(), 1e9)}})
                               .dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return 0;
}

} // namespace sward::texgen
