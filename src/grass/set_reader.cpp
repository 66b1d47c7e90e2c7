// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "grass/bc5.h"
#include "grass/blades_glb.h"
#include "grass/grass_set.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "grass/set_json.h"

namespace sward::grass {
namespace {

using base::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxSetBytes = std::uint64_t{2} << 30; // all arrays unpacked
constexpr int kMaxImages = 256;                                // layers, or slices an axis
constexpr std::size_t kMaxFarRows = 256;

shared::GrassAppearance read_look(const SetJson& set, const json& look) {
    shared::GrassAppearance out{};
    out.root = shared::vec3(set.colour(look, "root", 0));
    out.dry_share = set.real(look, "dry_share", 0, 1);
    out.tip = shared::vec3(set.colour(look, "tip", 0));
    out.variation = set.real(look, "variation", 0, 1);
    out.dry = shared::vec3(set.colour(look, "dry", 0));
    out.translucency = set.real(look, "translucency", 0, 1);
    out.gloss = {set.real(look, "kd", 0, 1000), set.real(look, "pd", 0, 1000),
                 set.real(look, "ks", 0, 1000), set.real(look, "ps", 0, 10000)};
    out.head = shared::vec3(set.colour(look, "head", 0));
    out.outline = {set.real(look, "taper", 0.1, 100), set.real(look, "stalk", 0, 1),
                   set.real(look, "head_from", 0, 1), set.real(look, "fullness", 0.01, 100)};
    return out;
}

void read_head(const SetJson& set, GrassSet& out) {
    const json& root = set.root();
    const int version = set.whole(root, "version", 0, 1 << 20);
    if (version != kSetFormatVersion)
        set.refuse("version", std::to_string(version),
                   fmt::format("{}: bake the set again", kSetFormatVersion));
    out.name = set.text(root, "preset");
    const json& seed = set.at(root, "seed");
    if (!seed.is_number_unsigned())
        set.refuse("seed", base::printable(seed.dump()), "a whole number from 0");
    out.seed = seed.get<std::uint64_t>();
    out.side_m = set.real(root, "side_m", 0.01, 1000);
    out.canopy_m = set.real(root, "canopy_m", 0.0001, 100);
    out.offset_range_m = set.real(root, "offset_range_m", 0.0001, 1000);
    out.variants = set.whole(root, "variants", 1, kMaxVariants);
    out.density_per_m2 = set.real(root, "density_per_m2", 0, 1e6);
    out.height_coding = set.whole(root, "height_coding", shared::kHeightNone, shared::kHeightTop);
    const json& floor = set.at(root, "floor");
    out.floor.cover = set.real(floor, "cover", 0, 1);
    out.floor.moss = glm::vec3(set.colour(floor, "moss", 0));
    out.floor.litter = glm::vec3(set.colour(floor, "litter", 0));
    for (const json& entry : set.array(root, "species", 1, shared::kMaxSpecies)) {
        Species species;
        species.name = set.text(entry, "name");
        species.element = set.text(entry, "element");
        species.share = set.real(entry, "share", 0, 1);
        species.look = read_look(set, set.at(entry, "look"));
        out.species.push_back(std::move(species));
    }
}

/// Metres above the ground, rising, within the canopy.
std::vector<float> read_heights(const SetJson& set, const json& level, const char* key,
                                std::size_t count, float canopy) {
    std::vector<float> heights;
    for (const json& value : set.array(level, key, count, count)) {
        heights.push_back(static_cast<float>(set.in_range(value, key, 0, canopy * 1.0001)));
        if (heights.size() > 1 && heights.back() <= heights[heights.size() - 2])
            set.refuse(key, fmt::format("{} after {}", heights.back(), heights[heights.size() - 2]),
                       "rising heights");
    }
    return heights;
}

void read_far(const SetJson& set, GrassSet& out) {
    const std::size_t levels = set.array(set.root(), "levels", 1, kMaxFarLevels).size();
    float last = 90.001f;
    for (const json& row : set.array(set.root(), "far", 1, kMaxFarRows)) {
        FarRow far;
        far.elevation_deg = set.real(row, "elevation_deg", 0, 90);
        far.coverage = set.real(row, "coverage", 0, 1);
        far.height = set.real(row, "height", 0, 1);
        far.along = set.real(row, "along", 0, 1);
        far.slice_share = set.real(row, "slice_share", 0, 1);
        std::vector<float> shares;
        for (const json& share : set.array(row, "shell_share", levels, levels))
            shares.push_back(
                static_cast<float>(set.in_range(share, "shell_share", 0, kMaxShellShare)));
        far.shell_share = shares[0];
        far.coarse_shares.assign(shares.begin() + 1, shares.end());
        if (far.elevation_deg >= last)
            set.refuse("far", fmt::format("{} degrees after {}", far.elevation_deg, last),
                       "falling elevations");
        last = far.elevation_deg;
        out.far.push_back(std::move(far));
    }
}

/// Degrees from `low` to `high`, rising or falling throughout.
std::vector<float> read_angles(const SetJson& set, const json& object, const char* key, double low,
                               double high, bool rising) {
    std::vector<float> angles;
    for (const json& value : set.array(object, key, 1, kMaxLightSteps)) {
        angles.push_back(static_cast<float>(set.in_range(value, key, low, high)));
        const std::size_t n = angles.size();
        if (n > 1 && (rising ? angles[n - 1] <= angles[n - 2] : angles[n - 1] >= angles[n - 2]))
            set.refuse(key, fmt::format("{} after {}", angles[n - 1], angles[n - 2]),
                       rising ? "rising numbers" : "falling numbers");
    }
    return angles;
}

void read_far_light(const SetJson& set, const fs::path& directory, GrassSet& out) {
    const json& table = set.at(set.root(), "far_light");
    FarLight& light = out.far_light;
    light.leans = read_angles(set, table, "leans", 0, 1, true);
    light.lean_azimuths_deg = read_angles(set, table, "lean_azimuths_deg", 0, 180, true);
    light.elevations_deg = read_angles(set, table, "elevations_deg", 0, 90, false);
    light.sun_elevations_deg = read_angles(set, table, "sun_elevations_deg", -90, 90, true);
    light.sun_azimuths = set.whole(table, "sun_azimuths", 1, static_cast<int>(kMaxLightSteps));
    if (light.leans.front() != 0)
        set.refuse("leans", std::to_string(light.leans.front()), "0, at rest, first");
    const std::vector<float>& azimuths = light.lean_azimuths_deg;
    if (azimuths.front() != 0 || (azimuths.size() > 1 && azimuths.back() != 180))
        set.refuse("lean_azimuths_deg", fmt::format("{} to {}", azimuths.front(), azimuths.back()),
                   "0 to 180, or 0 alone");
    if (!std::ranges::equal(light.elevations_deg, out.far, {}, {}, &FarRow::elevation_deg))
        set.refuse("elevations_deg", fmt::format("{} others", light.elevations_deg.size()),
                   "those of far");
    decode_far_light(
        decode_ktx2(verified_file(set, directory, kFarLightFile), directory / kFarLightFile),
        directory / kFarLightFile, light);
}

/// One family of a level: both planes, from one file or, with `shape`, from two.
struct FamilyFiles {
    std::string planes, shape;
    int images = 0; ///< of each plane
};

void read_family(const SetJson& set, const fs::path& directory, const FamilyFiles& files,
                 TextureArray& planes, TextureArray* shape) {
    if (!shape) {
        planes = read_array(set, directory, files.planes, files.images * shared::kPlanes);
        return;
    }
    const TextureArray ids = read_array(set, directory, files.planes, files.images);
    *shape = read_array(set, directory, files.shape, files.images * 2, TexelFormat::kBc5);
    if (shape->width != ids.width || shape->height != ids.height ||
        shape->mips.size() != ids.mips.size())
        throw base::input_error(
            ExitCode::kBadInput, directory / files.shape, 0, "size",
            fmt::format("{} x {}, {} mips", shape->width, shape->height, shape->mips.size()),
            fmt::format("{} x {}, {} mips as in {}", ids.width, ids.height, ids.mips.size(),
                        files.planes));
    if (mip_bytes(ids, 0) > kMaxArrayBytes / (2 * shared::kPlanes))
        throw base::input_error(ExitCode::kOverLimit, directory / files.planes, 0, "array",
                                fmt::format("{} bytes of ids", mip_bytes(ids, 0)),
                                "at most 256 MiB");
    planes = join_planes(ids, *shape);
}

void read_levels(const SetJson& set, const fs::path& directory, GrassSet& out) {
    std::uint64_t total = 0;
    const json& levels = set.array(set.root(), "levels", 1, kMaxFarLevels);
    for (int k = 0; k < static_cast<int>(levels.size()); ++k) {
        const json& entry = levels[static_cast<std::size_t>(k)];
        FarLevel level;
        level.layer_count = set.whole(entry, "layer_count", 1, kMaxImages);
        level.slice_count = set.whole(entry, "slice_count", 1, kMaxImages);
        level.layer_edges =
            read_heights(set, entry, "layer_edges_m",
                         static_cast<std::size_t>(level.layer_count) + 1, out.canopy_m);
        level.layer_heights =
            read_heights(set, entry, "layer_heights_m", static_cast<std::size_t>(level.layer_count),
                         out.canopy_m);
        // Names are ours, not the file's: nothing outside the directory can be asked for.
        const bool block = entry.contains("layers_shape");
        if (k > 0 && block != !out.levels[0].layers_shape.mips.empty())
            set.refuse("levels", fmt::format("level {} packed otherwise than level 0", k),
                       "BC5 in all levels or in none");
        read_family(set, directory,
                    {layers_file(k), layers_shape_file(k), out.variants * layer_images(out, level)},
                    level.layers, block ? &level.layers_shape : nullptr);
        read_family(set, directory,
                    {slices_file(k), slices_shape_file(k), out.variants * 2 * level.slice_count},
                    level.slices, block ? &level.slices_shape : nullptr);
        if (level.layers.width != level.layers.height || level.layers.width != level.slices.width)
            set.refuse("levels",
                       fmt::format("layers {} x {}, slices {} wide", level.layers.width,
                                   level.layers.height, level.slices.width),
                       "square layers and slices of the same width");
        if (k > 0 && level.layers.width != std::max(1, out.levels[0].layers.width >> k))
            set.refuse("levels", fmt::format("{} texels at level {}", level.layers.width, k),
                       "half of the level before");
        for (const TextureArray* array : {&level.layers, &level.slices})
            for (const auto& mip : array->mips)
                total += mip.size();
        if (total > kMaxSetBytes)
            set.over("textures", fmt::format("{} bytes", total),
                     fmt::format("at most {}", kMaxSetBytes));
        out.levels.push_back(std::move(level));
    }
}

void read_blades(const SetJson& set, const fs::path& directory, GrassSet& out) {
    BladeList list = decode_blades(verified_file(set, directory, kBladesFile),
                                   directory / kBladesFile, out.side_m);
    if (static_cast<int>(list.variant_begin.size()) != out.variants + 1)
        set.refuse("variants", std::to_string(out.variants),
                   fmt::format("{} as in {}", list.variant_begin.size() - 1, kBladesFile));
    out.blades = std::move(list.blades);
    out.variant_begin = std::move(list.variant_begin);
    for (const shared::BladeRecord& blade : out.blades)
        if (!(blade.shape.w >= 0 && blade.shape.w < static_cast<float>(out.species.size())) ||
            blade.shape.w != std::floor(blade.shape.w))
            set.refuse("species", fmt::format("a blade of number {}", blade.shape.w),
                       fmt::format("a whole number below {}", out.species.size()));
}

} // namespace

std::vector<std::byte> read_set_file(const fs::path& directory, const std::string& name) {
    return verified_file(SetJson(directory / kSetJson), directory, name);
}

GrassSet read_grass_set(const fs::path& directory) {
    const SetJson set(directory / kSetJson);
    GrassSet out;
    read_head(set, out);
    read_far(set, out);
    out.variant_begin.assign(static_cast<std::size_t>(out.variants) + 1, 0);
    if (set.whole(set.root(), "blades", 0, 1 << 30) >
        0) // a far-only set has none, and no such file
        read_blades(set, directory, out);
    read_far_light(set, directory, out);
    read_march(set, directory, out);
    read_levels(set, directory, out);
    return out;
}

} // namespace sward::grass
