// SPDX-License-Identifier: Apache-2.0
#include "texgen/report/report.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"

namespace sward::texgen {
namespace {

using nlohmann::ordered_json;

std::uint64_t array_bytes(const grass::TextureArray& array) {
    std::uint64_t sum = 0;
    for (const std::vector<std::uint8_t>& mip : array.mips)
        sum += mip.size();
    return sum;
}

/// A row of the text: a name in a column of its own.
std::string row(std::string_view name, const std::string& text) {
    return fmt::format("{:<10}{}\n", name, text);
}

std::string percent(double share) {
    return fmt::format("{:.1f} %", 100 * share);
}

std::string levels_text(const SetReport& r) {
    std::string text;
    for (std::size_t k = 0; k < r.levels.size(); ++k) {
        const LevelReport& level = r.levels[k];
        text += row(
            fmt::format("level {}", k),
            fmt::format(
                "{} x {} texels of {:.2f} mm, {} layers, {} + {} slices of {} rows, {} mips, {} on "
                "the GPU",
                level.size, level.size, 1000 * level.texel_m, level.layers, level.slices,
                level.slices, level.rows, level.mips, readable_bytes(level.gpu_bytes)));
    }
    return text;
}

std::string far_text(const SetReport& r) {
    std::string text;
    for (const grass::FarRow& far : r.far) {
        std::string shares;
        for (std::size_t k = 0; k < r.levels.size(); ++k)
            shares += fmt::format(" {:.2f}", far.share_at(static_cast<int>(k)));
        text +=
            row(text.empty() ? "far" : "",
                fmt::format("{:4.1f} degrees: coverage {:>7}, mean height {:.3f}, slices {:.2f}, "
                            "shells by level{}",
                            far.elevation_deg, percent(far.coverage), far.height, far.slice_share,
                            shares));
    }
    return text;
}

std::string files_text(const SetReport& r) {
    std::string text;
    for (const FileReport& file : r.files) {
        std::string line = fmt::format("{:<22}", file.name);
        if (file.bytes)
            line += fmt::format("{:>11}", readable_bytes(file.bytes));
        if (file.raw_bytes)
            line += fmt::format("{:>11} unpacked", readable_bytes(file.raw_bytes));
        text += row(text.empty() ? "files" : "", line);
    }
    return text;
}

ordered_json levels_json(const SetReport& r) {
    ordered_json levels = ordered_json::array();
    for (const LevelReport& level : r.levels)
        levels.push_back({{"size", level.size},
                          {"texel_m", level.texel_m},
                          {"layers", level.layers},
                          {"slices", level.slices},
                          {"rows", level.rows},
                          {"mips", level.mips},
                          {"gpu_bytes", level.gpu_bytes}});
    return levels;
}

ordered_json far_json(const SetReport& r) {
    ordered_json rows = ordered_json::array();
    for (const grass::FarRow& far : r.far) {
        ordered_json shares = ordered_json::array();
        for (std::size_t k = 0; k < r.levels.size(); ++k)
            shares.push_back(far.share_at(static_cast<int>(k)));
        rows.push_back({{"elevation_deg", far.elevation_deg},
                        {"coverage", far.coverage},
                        {"height", far.height},
                        {"slice_share", far.slice_share},
                        {"shell_share", shares}});
    }
    return rows;
}

ordered_json files_json(const SetReport& r) {
    ordered_json files = ordered_json::object();
    for (const FileReport& file : r.files) {
        ordered_json entry = ordered_json::object();
        if (file.bytes)
            entry["bytes"] = file.bytes;
        if (file.raw_bytes)
            entry["unpacked_bytes"] = file.raw_bytes;
        if (!file.sha256.empty())
            entry["sha256"] = file.sha256;
        files[file.name] = std::move(entry);
    }
    return files;
}

} // namespace

std::string readable_bytes(std::uint64_t bytes) {
    if (bytes < 1024)
        return fmt::format("{} B", bytes);
    const bool small = bytes < 1 << 20;
    return fmt::format("{:.1f} {}", static_cast<double>(bytes) / (small ? 1 << 10 : 1 << 20),
                       small ? "KiB" : "MiB");
}

std::size_t SetReport::images() const {
    std::size_t count = 0;
    for (const LevelReport& level : levels)
        count += static_cast<std::size_t>(variants * (level.layers + 2 * level.slices));
    return count;
}

SetReport report_of(const grass::GrassSet& set, const std::string& path,
                    const std::vector<FileEntry>& files) {
    SetReport r;
    r.path = path;
    r.name = set.name;
    r.seed = set.seed;
    r.side_m = set.side_m;
    r.canopy_m = set.canopy_m;
    r.variants = set.variants;
    r.density_per_m2 = set.density_per_m2;
    r.blades = set.blades.size();
    r.far = set.far;
    for (const FileEntry& file : files)
        r.files.push_back({file.name, file.bytes, 0, file.sha256});
    const auto unpacked = [&](const std::string& name, std::uint64_t bytes) {
        if (const auto at = std::ranges::find(r.files, name, &FileReport::name);
            at != r.files.end())
            at->raw_bytes = bytes;
        return bytes;
    };
    for (std::size_t k = 0; k < set.levels.size(); ++k) {
        const grass::FarLevel& level = set.levels[k];
        const int number = static_cast<int>(k);
        const bool block = !level.layers_shape.mips.empty();
        r.block_compressed = r.block_compressed || block;
        std::uint64_t bytes =
            unpacked(grass::layers_file(number), array_bytes(level.layers) / (block ? 2 : 1)) +
            unpacked(grass::slices_file(number), array_bytes(level.slices) / (block ? 2 : 1));
        if (block)
            bytes += unpacked(grass::layers_shape_file(number), array_bytes(level.layers_shape)) +
                     unpacked(grass::slices_shape_file(number), array_bytes(level.slices_shape));
        r.levels.push_back({level.layers.width,
                            set.side_m / static_cast<double>(level.layers.width), level.layer_count,
                            level.slice_count, level.slices.height,
                            static_cast<int>(level.layers.mips.size()), bytes});
        r.gpu_bytes += bytes;
    }
    for (const grass::Species& species : set.species)
        r.species.push_back(
            fmt::format("{} ({}) {}", species.name, species.element, percent(species.share)));
    const auto add_march = [&](const std::string& name, const grass::TextureArray& array) {
        r.gpu_bytes += unpacked(name, array_bytes(array));
    };
    add_march(grass::kColumnsFile, set.march.columns.density);
    add_march(grass::kColumnFibresFile, set.march.columns.fibres);
    for (int k = 0; k < shared::kMarchSets; ++k) {
        add_march(grass::slabs_file(k), set.march.slabs[static_cast<std::size_t>(k)].density);
        add_march(grass::slab_fibres_file(k), set.march.slabs[static_cast<std::size_t>(k)].fibres);
    }
    r.gpu_bytes += set.blades.size() * sizeof(shared::BladeRecord);
    return r;
}

std::string report_text(const SetReport& r) {
    std::string text = row(r.path.empty() ? "set" : r.path + ":",
                           fmt::format(" grass set \"{}\", format {}, seed {}", r.name,
                                       grass::kSetFormatVersion, r.seed));
    text += row("patch", fmt::format("{} m, {} variants, {} blades, {:.0f} a square metre",
                                     r.side_m, r.variants, r.blades, r.density_per_m2));
    text += row("canopy", fmt::format("{:.3f} m", r.canopy_m));
    for (std::size_t i = 0; i < r.species.size(); ++i)
        text += row(i == 0 ? "species" : "", r.species[i]);
    text += levels_text(r);
    text += row("images", std::to_string(r.images()));
    text += far_text(r);
    text += files_text(r);
    std::uint64_t disk = 0;
    for (const FileReport& file : r.files)
        disk += file.bytes;
    if (disk)
        text += row("disk", readable_bytes(disk));
    text += row("GPU",
                readable_bytes(r.gpu_bytes) + (r.block_compressed ? ", shape planes as BC5" : ""));
    if (r.peak_bytes)
        text += row("memory", fmt::format("about {} at its peak", readable_bytes(*r.peak_bytes)));
    if (r.seconds)
        text += row("time", fmt::format("{:.1f} s", *r.seconds));
    return text;
}

std::string report_json(const SetReport& r) {
    ordered_json root = {{"set", r.path},
                         {"version", grass::kSetFormatVersion},
                         {"preset", r.name},
                         {"seed", r.seed},
                         {"side_m", r.side_m},
                         {"canopy_m", r.canopy_m},
                         {"variants", r.variants},
                         {"density_per_m2", r.density_per_m2},
                         {"blades", r.blades},
                         {"species", r.species},
                         {"block_compressed", r.block_compressed},
                         {"images", r.images()},
                         {"levels", levels_json(r)},
                         {"far", far_json(r)},
                         {"files", files_json(r)},
                         {"gpu_bytes", r.gpu_bytes}};
    if (r.peak_bytes)
        root["peak_bytes"] = *r.peak_bytes;
    if (r.seconds)
        root["seconds"] = *r.seconds;
    return root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void print_result(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw base::Error(
            base::ExitCode::kIo,
            "standard output: cannot write: found no room, expected room for the report");
}

} // namespace sward::texgen
