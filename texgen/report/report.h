// SPDX-License-Identifier: Apache-2.0
// What is in a set, or would be: for inspect, for --dry-run, for --json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/bake/writer.h"

namespace sward::texgen {

struct LevelReport {
    int size = 0; ///< texels a side
    double texel_m = 0;
    int layers = 0;
    int slices = 0; ///< an axis
    int rows = 0;   ///< of a slice
    int mips = 0;
    std::uint64_t gpu_bytes = 0; ///< both arrays with all mips
};

/// A file, on disk or to be written.
struct FileReport {
    std::string name;
    std::uint64_t bytes = 0;     ///< on disk; 0: not known
    std::uint64_t raw_bytes = 0; ///< unpacked; 0: not packed
    std::string sha256;
};

struct SetReport {
    std::string path;
    std::string name;
    std::uint64_t seed = 0;
    double side_m = 0;
    double canopy_m = 0;
    int variants = 0;
    double density_per_m2 = 0;
    std::size_t blades = 0;
    std::vector<std::string> species; ///< "grass (blade) 85 %"
    bool block_compressed = false;
    std::vector<LevelReport> levels;
    std::vector<grass::FarRow> far;
    std::vector<FileReport> files;
    std::uint64_t gpu_bytes = 0;             ///< textures and blades
    std::optional<std::uint64_t> peak_bytes; ///< --dry-run: memory that the bake takes
    std::optional<double> seconds;           ///< a bake's time

    [[nodiscard]] std::size_t images() const; ///< of all levels: layers and slices of all variants
};

/// Of a set in memory. Files come from its writer or its set.json.
[[nodiscard]] SetReport report_of(const grass::GrassSet& set, const std::string& path,
                                  const std::vector<FileEntry>& files);

[[nodiscard]] std::string report_text(const SetReport& report);
[[nodiscard]] std::string report_json(const SetReport& report);

/// A result on standard output. Throws base::Error(kIo) when it does not arrive there.
void print_result(const std::string& text);

/// "1.5 MiB".
[[nodiscard]] std::string readable_bytes(std::uint64_t bytes);

} // namespace sward::texgen
