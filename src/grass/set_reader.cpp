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
#include "grass/far_medium.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "shared/march.h"

namespace sward::grass {
namespace {

using base::ExitCode;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxSetBytes = std::uint64_t{2} << 30; // all arrays unpacked
constexpr int kMaxImages = 256;                                // layers, or slices an axis
constexpr std::size_t kMaxFarRows = 256;

/// set.json with every access checked.
class SetJson {
public:
    SetJson(const fs::path& path) : path_(path) {
        const std::string text = base::read_text(path, kMaxSetJsonBytes);
        check_depth(text);
        root_ = json::parse(text, nullptr, false);
        if (!root_.is_object())
            refuse("JSON", "something else", "a grass set's description");
    }

    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(ExitCode::kBadInput, path_, 0, what, found, expected);
    }
    [[noreturn]] void over(std::string_view what, const std::string& found,
                           const std::string& expected) const {
        throw base::input_error(ExitCode::kOverLimit, path_, 0, what, found, expected);
    }
    const json& root() const { return root_; }

    const json& at(const json& object, const char* key) const {
        if (!object.is_object() || !object.contains(key))
            refuse(key, "none", "a value");
        return object[key];
    }
    double number(const json& object, const char* key, double low, double high) const {
        return in_range(at(object, key), key, low, high);
    }
    double in_range(const json& value, const char* key, double low, double high) const {
        const double v = value.is_number() ? value.get<double>() : std::nan("");
        if (!(v >= low && v <= high))
            refuse(key, base::printable(value.dump()),
                   fmt::format("a number from {} to {}", low, high));
        return v;
    }
    float real(const json& object, const char* key, double low, double high) const {
        return static_cast<float>(number(object, key, low, high));
    }
    int whole(const json& object, const char* key, int low, int high) const {
        const double v = number(object, key, low, high);
        if (v != std::floor(v))
            refuse(key, std::to_string(v), "a whole number");
        return static_cast<int>(v);
    }
    std::string text(const json& object, const char* key) const {
        const json& value = at(object, key);
        if (!value.is_string() || value.get_ref<const std::string&>().size() > 128)
            refuse(key, base::printable(value.dump()), "a short text");
        return value.get<std::string>();
    }
    const json& array(const json& object, const char* key, std::size_t low,
                      std::size_t high) const {
        const json& value = at(object, key);
        if (!value.is_array() || value.size() < low || value.size() > high)
            refuse(key, value.is_array() ? fmt::format("{} entries", value.size()) : "no list",
                   fmt::format("{} to {} entries", low, high));
        return value;
    }
    shared::vec4 colour(const json& object, const char* key, float a) const {
        const json& list = array(object, key, 3, 3);
        shared::vec4 c(0, 0, 0, a);
        for (int i = 0; i < 3; ++i) {
            const json& part = list[static_cast<std::size_t>(i)];
            const double v = part.is_number() ? part.get<double>() : std::nan("");
            if (!(v >= 0 && v <= 1))
                refuse(key, base::printable(part.dump()), "linear reflectance from 0 to 1");
            c[i] = static_cast<float>(v);
        }
        return c;
    }

private:
    void check_depth(const std::string& text) const {
        int depth = 0;
        for (const char c : text) {
            depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
            if (depth > 32)
                refuse("JSON", "deeper nesting", "at most 32 levels");
        }
    }

    fs::path path_;
    json root_;
};

/// A file of the set, whole and as its writer left it, or an error.
std::vector<std::byte> verified_file(const SetJson& set, const fs::path& directory,
                                     const std::string& name) {
    const json& entry = set.at(set.at(set.root(), "files"), name.c_str());
    const auto size = static_cast<std::uint64_t>(
        set.number(entry, "bytes", 0, static_cast<double>(kMaxFileBytes)));
    const std::string expected = set.text(entry, "sha256");
    std::vector<std::byte> bytes = base::read_file(directory / name, kMaxFileBytes);
    if (bytes.size() != size)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "size",
                                fmt::format("{} bytes", bytes.size()),
                                fmt::format("{} as in {}", size, kSetJson));
    const std::string found = base::sha256_hex(bytes);
    if (found != expected)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "SHA-256",
                                found.substr(0, 16) + "...",
                                base::printable(expected.substr(0, 16)) + "... as in " + kSetJson);
    return bytes;
}

shared::GrassAppearance read_look(const SetJson& set, const json& look) {
    shared::GrassAppearance out;
    out.root = set.colour(look, "root", set.real(look, "dry_share", 0, 1));
    out.tip = set.colour(look, "tip", set.real(look, "variation", 0, 1));
    out.dry = set.colour(look, "dry", set.real(look, "translucency", 0, 1));
    out.light = {set.real(look, "kd", 0, 1000), set.real(look, "pd", 0, 1000),
                 set.real(look, "ks", 0, 1000), set.real(look, "ps", 0, 10000)};
    out.head = set.colour(look, "head", 0);
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
std::vector<float> read_heights(const SetJson& set, const json& level, const char* key, std::size_t count, float canopy) {
    std::vector<float> heights;
    for (const json& value : set.array(level, key, count, count)) {
        heights.push_back(static_cast<float>(set.in_range(value, key, 0, canopy * 1.0001)));
        if (heights.size() > 1 && heights.back() <= heights[heights.size() - 2])
            set.refuse(key, fmt::format("{} after {}", heights.back(), heights[heights.size() - 2]), "rising heights");
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
            shares.push_back(static_cast<float>(set.in_range(share, "shell_share", 0, kMaxShellShare)));
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
std::vector<float> read_angles(const SetJson& set, const json& object, const char* key, double low, double high, bool rising) {
    std::vector<float> angles;
    for (const json& value : set.array(object, key, 1, kMaxLightSteps)) {
        angles.push_back(static_cast<float>(set.in_range(value, key, low, high)));
        const std::size_t n = angles.size();
        if (n > 1 && (rising ? angles[n - 1] <= angles[n - 2] : angles[n - 1] >= angles[n - 2]))
            set.refuse(key, fmt::format("{} after {}", angles[n - 1], angles[n - 2]), rising ? "rising numbers" : "falling numbers");
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
        set.refuse("lean_azimuths_deg", fmt::format("{} to {}", azimuths.front(), azimuths.back()), "0 to 180, or 0 alone");
    if (!std::ranges::equal(light.elevations_deg, out.far, {}, {}, &FarRow::elevation_deg))
        set.refuse("elevations_deg", fmt::format("{} others", light.elevations_deg.size()), "those of far");
    decode_far_light(decode_ktx2(verified_file(set, directory, kFarLightFile), directory / kFarLightFile),
                     directory / kFarLightFile, light);
}

TextureArray read_array(const SetJson& set, const fs::path& directory, const std::string& name,
                        int images, TexelFormat format = TexelFormat::kRgba8) {
    TextureArray array = decode_ktx2(verified_file(set, directory, name), directory / name);
    if (array.plain)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "shape", "a single texture", "a 2D array");
    if (array.layers != images)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "images",
                                std::to_string(array.layers), std::to_string(images));
    if (array.format != format)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "format", "another",
                                format == TexelFormat::kBc5 ? "BC5 UNORM" : "RGBA8 UNORM");
    return array;
}

std::vector<float> read_numbers(const SetJson& set, const json& object, const char* key, std::size_t count, double high) {
    std::vector<float> numbers;
    for (const json& value : set.array(object, key, count, count))
        numbers.push_back(static_cast<float>(set.in_range(value, key, 0, high)));
    return numbers;
}

/// One of the march's arrays: its shape is the reader's to know.
TextureArray read_march_array(const SetJson& set, const fs::path& directory, const std::string& name, glm::ivec3 shape,
                              TexelFormat format) {
    TextureArray array = read_array(set, directory, name, shape.z, format);
    if (array.width != shape.x || array.height != shape.y)
        throw base::input_error(ExitCode::kBadInput, directory / name, 0, "size", fmt::format("{} x {}", array.width, array.height),
                                fmt::format("{} x {}", shape.x, shape.y));
    return array;
}

void read_march(const SetJson& set, const fs::path& directory, GrassSet& out) {
    const json& march = set.at(set.root(), "march");
    shared::MarchMedium& medium = out.march.medium;
    constexpr double kMostArea = 1e6; // m2 over a m2
    const auto rows = [&](const char* key, std::size_t count, std::size_t numbers, double high) {
        std::vector<std::vector<float>> out_rows;
        for (const json& row : set.array(march, key, count, count))
            out_rows.push_back(read_numbers(set, json{{key, row}}, key, numbers, high));
        return out_rows;
    };
    const auto edges = rows("edges", shared::kMarchLayers + 1, 4, kMostArea);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        medium.edges[i] = {edges[i][0], edges[i][1], edges[i][2], edges[i][3]};
        if (i > 0 && !(edges[i][3] > edges[i - 1][3]))
            set.refuse("edges", fmt::format("height {} after {}", edges[i][3], edges[i - 1][3]), "rising heights");
    }
    const auto layers = rows("layers", shared::kMarchLayers, 2, 1.0001);
    const auto level = rows("level_tint", shared::kMarchLayers, 3, 10), steep = rows("steep_tint", shared::kMarchLayers, 3, 10);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        medium.layers[i] = {layers[i][0], layers[i][1], 0, 0};
        medium.level_tint[i] = {level[i][0], level[i][1], level[i][2], 0};
        medium.steep_tint[i] = {steep[i][0], steep[i][1], steep[i][2], 0};
    }
    const std::vector<float> look = read_numbers(set, march, "look", 4, 10000);
    medium.look = {look[0], look[1], look[2], look[3]};
    medium.size = {out.side_m, out.canopy_m, set.real(march, "translucency", 0, 1), static_cast<float>(out.variants)};
    shared::fill_views(medium);
    constexpr int kTexels = shared::kMarchTexels, kRows = kMarchRows;
    const int columns = kTexels >> shared::kColumnBase;
    const auto arrays = [&](const std::string& density, const std::string& fibres, glm::ivec3 shape) {
        return MarchArrays{read_march_array(set, directory, density, shape, TexelFormat::kRgba16f),
                           read_march_array(set, directory, fibres, shape, TexelFormat::kRgba8)};
    };
    out.march.columns = arrays(kColumnsFile, kColumnFibresFile, {columns, columns, out.variants * shared::kMarchLayers});
    for (int k = 0; k < shared::kMarchSets; ++k)
        out.march.slabs[k] = arrays(slabs_file(k), slab_fibres_file(k), {kTexels >> k, kRows, out.variants * 2 * (shared::kFinestSlabs >> k)});
    decode_correction(read_array(set, directory, kCorrectionFile, static_cast<int>(kMarchDensities.size()), TexelFormat::kRgba32f),
                      directory / kCorrectionFile, out.march);
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
        throw base::input_error(ExitCode::kBadInput, directory / files.shape, 0, "size",
                                fmt::format("{} x {}, {} mips", shape->width, shape->height,
                                            shape->mips.size()),
                                fmt::format("{} x {}, {} mips as in {}", ids.width, ids.height,
                                            ids.mips.size(), files.planes));
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
        level.layer_edges = read_heights(set, entry, "layer_edges_m",
                                         static_cast<std::size_t>(level.layer_count) + 1, out.canopy_m);
        level.layer_heights = read_heights(set, entry, "layer_heights_m",
                                           static_cast<std::size_t>(level.layer_count), out.canopy_m);
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
    if (set.whole(set.root(), "blades", 0, 1 << 30) > 0) // a far-only set has none, and no such file
        read_blades(set, directory, out);
    read_far_light(set, directory, out);
    read_march(set, directory, out);
    read_levels(set, directory, out);
    return out;
}

} // namespace sward::grass
