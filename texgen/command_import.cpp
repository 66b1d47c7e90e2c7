// SPDX-License-Identifier: Apache-2.0
// `texgen import`: a volume from another program becomes a far-only set.
#include <algorithm>
#include <cctype>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "texgen/commands.h"
#include "texgen/import.h"
#include "texgen/seam.h"
#include "texgen/vdb_file.h"
#include "texgen/writer.h"

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

/// The file's volume, made periodic if that is asked for.
Volume load(const ImportOptions& options) {
    const std::vector<std::byte> bytes = base::read_file(options.input, kMaxVdbBytes);
    const Volume volume = VdbFile(bytes, options.input).read_volume({.z_up = options.z_up, .scale = options.scale});
    if (options.seam)
        return seam_volume(volume, options.cut < 1 ? SeamCut{.share = options.cut} : SeamCut{.texels = static_cast<int>(options.cut)}, options.input);
    return volume;
}

} // namespace

int run_import(const ImportOptions& options) {
    base::set_verbosity(options.verbosity);
    if (options.seam && !(options.cut > 0))
        throw base::Error(base::ExitCode::kUsage, "--cut: found 0, expected a share of the side below 1, or texels from 3");
    require_set_place(options.output);
    const Volume volume = load(options);
    const JointReport joint = volume.cells.x == volume.cells.z ? joint_of(volume) : JointReport{};
    if (joint.ratio() > kMostJointRatio)
        base::log_warning(fmt::format("{}: the joint's gradient is {:.2f} times the interior's: the volume is not periodic{}",
                                      options.input.string(), joint.ratio(), options.seam ? "; try another --cut" : ", --seam makes it so"));
    ImportQuery query{.name = options.name, .density = options.density, .size = options.size, .layers = options.layers,
                      .slices = options.slices, .levels = options.levels, .threads = options.threads};
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
                                                   {"joint", joint.ratio()}})
                               .dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return 0;
}

} // namespace sward::texgen
