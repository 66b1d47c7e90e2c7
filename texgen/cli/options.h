// SPDX-License-Identifier: Apache-2.0
// The command line of texgen, parsed: one struct a command.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/log.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {

/// What every command takes.
struct CommonOptions {
    int threads = 0; ///< 0: one a core
    bool json = false;
    base::Verbosity verbosity = base::Verbosity::kNormal;
};

/// How the KTX2 files of a set are packed.
struct Compression {
    int zstd_level = 3; ///< 0: no supercompression
    bool block = false; ///< shape planes as BC5
};

enum class ExportFormat { kNone, kPng, kExr };

/// A number of the preset that an option replaces.
struct Override {
    std::string option; ///< "--size"
    std::string key;    ///< "texture.size"
    std::int64_t value = 0;
};

/// `texgen PRESET -o DIR`.
struct BakeCommandOptions : CommonOptions {
    std::string preset;
    std::filesystem::path output; ///< without a trailing slash
    std::vector<Override> overrides;
    std::optional<HeightMap> height_map; ///< instead of the preset's
    Compression compression;
    ExportFormat export_format = ExportFormat::kNone;
    std::optional<std::filesystem::path> preview_file; ///< instead of preview.png inside the set
    bool preview = true;
    bool volume = true;
    bool check_nan = false;
    bool dry_run = false; ///< `output` may then be empty
    bool list = false;    ///< of the shipped presets, and nothing else
    bool wrap = true;     ///< false: a set that shows its joints, for tests
};

/// `texgen seam IN -o OUT`.
struct SeamOptions : CommonOptions {
    std::filesystem::path input; ///< a directory, a pattern, a picture or a .vdb
    std::filesystem::path output;
    double cut = 0.125; ///< share of the side below 1, else texels
    bool z_up = false;  ///< of a .vdb
};

/// `texgen import FILE.vdb -o SET`, `texgen import DIR -o SET`.
struct ImportOptions : CommonOptions {
    std::filesystem::path input; ///< a .vdb, or a directory of pictures with a stack.json
    std::filesystem::path output;
    std::string name; ///< of the set; empty: the file's own, else its name
    bool z_up = false;
    double scale = 1;    ///< metres a unit of the file
    double period_m = 0; ///< of the volume, metres; 0: as the file says
    double side_m = 0;   ///< of a stack of pictures; 0: as its stack.json says
    double canopy_m = 0; ///< likewise
    double density = 1;  ///< factor on the density
    int size = 0;        ///< texels a side at level 0; 0: the power of two nearest to the voxels
    int layers = 16;
    int slices = 16;
    int levels = 4;
    int far_rays = kFarRays; ///< of a view, as in a preset
    bool seam = false;
    double cut = 0.125; ///< as SeamOptions
    Compression compression;
    bool preview = true;
};

/// What `texgen export` writes.
enum class ExportTarget { kGltf, kTextures, kBlender };

/// `texgen export SET -o DIR --for gltf|textures|blender`.
struct ExportCommandOptions : CommonOptions {
    std::filesystem::path input;
    std::filesystem::path output; ///< without a trailing slash
    ExportTarget target = ExportTarget::kGltf;
    Compression compression;
    bool atlases = true;
};

/// `texgen inspect SET`.
struct InspectOptions : CommonOptions {
    std::filesystem::path input; ///< a set's directory, a .ktx2 or a .vdb
};

/// `texgen verify SET`.
struct VerifyOptions : CommonOptions {
    std::filesystem::path input;
};

struct Options {
    BakeCommandOptions bake;
    SeamOptions seam;
    ImportOptions import;
    ExportCommandOptions exporting; ///< `export` is a keyword
    InspectOptions inspect;
    VerifyOptions verify;
    std::string help; ///< the text that --help or --version asked for, or empty
    /// The command's function; null when `help` is set.
    int (*run)(const Options&) = nullptr;
};

/// Parses the command line. Throws base::Error(kUsage) in one line.
[[nodiscard]] Options parse_options(int argc, char** argv);

} // namespace sward::texgen
