// SPDX-License-Identifier: Apache-2.0
#include "texgen/preset.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/error.h"
#include "base/file.h"
#include "texgen/preset_fields.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPresetBytes = 1 << 20;
constexpr double kMaxBlades = 200000;      // a variant: the renderer's lists and the ranking's time
constexpr double kMaxArrayBytes = 1 << 30; // robustness: one texture array
constexpr double kMaxArrayLayers = 2048;
constexpr double kMarginShare = 0.02; // of the side, on top of the reach
constexpr double kMaxTipDeg = 150;    // a curve that rolls up would leave its own slab order

int line_of(const toml::node& node) {
    return static_cast<int>(node.source().begin.line);
}

int edit_distance(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string shown(const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    return base::printable(text.str());
}

std::string nearest_key(std::string_view section, std::string_view key) {
    std::string best;
    int least = 1 << 20;
    const std::string full =
        section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
    for (const Field& field : preset_fields())
        for (const std::string_view name :
             {std::string_view(field.key), std::string_view(field.section)}) {
            if (name.empty())
                continue;
            const bool whole = name == field.key;
            const std::string candidate = whole ? field.full_key() : std::string(name);
            const int distance =
                std::min(edit_distance(full, candidate),
                         edit_distance(key, name) + (whole && field.section != section ? 1 : 0));
            if (distance < least) {
                least = distance;
                best = candidate;
            }
        }
    return best;
}

/// Reads one node into its field.
struct Reader {
    const fs::path& file;
    const Field& field;
    const toml::node& node;

    [[noreturn]] void refuse() const {
        throw base::input_error(ExitCode::kBadInput, file, line_of(node), field.full_key(),
                                shown(node), field.expected());
    }
    double number(const toml::node& item) const {
        const std::optional<double> value = item.is_number() ? item.value<double>() : std::nullopt;
        // Written so that NaN is refused too.
        if (!value || !(*value >= field.low && *value <= field.high))
            refuse();
        return *value;
    }
    template<std::size_t N> std::array<double, N> numbers() const {
        const toml::array* items = node.as_array();
        if (!items || items->size() != N)
            refuse();
        std::array<double, N> values;
        for (std::size_t i = 0; i < N; ++i)
            values[i] = number((*items)[i]);
        return values;
    }
    void into(Preset& preset) const {
        if (const auto* text = std::get_if<std::string Preset::*>(&field.target)) {
            const std::string value = node.is_string() ? node.value<std::string>().value() : "";
            const bool clean = std::ranges::all_of(value, [](char c) {
                return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
            });
            if (value.empty() || value.size() > 64 || !clean)
                refuse();
            preset.*(*text) = value;
        } else if (const auto* whole = std::get_if<std::int64_t Preset::*>(&field.target)) {
            if (!node.is_integer())
                refuse();
            preset.*(*whole) = static_cast<std::int64_t>(number(node));
        } else if (const auto* real = std::get_if<double Preset::*>(&field.target)) {
            preset.*(*real) = number(node);
        } else if (const auto* range = std::get_if<Range Preset::*>(&field.target)) {
            const auto [low, high] = numbers<2>();
            if (low > high)
                refuse();
            preset.*(*range) = {low, high};
        } else if (const auto* colour = std::get_if<Colour Preset::*>(&field.target)) {
            preset.*(*colour) = numbers<3>();
        }
    }
};

void read_entry(Preset& preset, const fs::path& file, std::string_view section,
                const toml::key& key, const toml::node& node) {
    for (const Field& field : preset_fields())
        if (field.section == section && field.key == key.str()) {
            Reader{file, field, node}.into(preset);
            return;
        }
    throw base::input_error(ExitCode::kBadInput, file, static_cast<int>(key.source().begin.line),
                            "unknown key", base::printable(key.str()),
                            fmt::format("a key such as {}", nearest_key(section, key.str())));
}

bool is_section(std::string_view name) {
    return std::ranges::any_of(preset_fields(), [&](const Field& field) {
        return !name.empty() && field.section == name;
    });
}

double array_bytes(double width, double height, double images) {
    return width * height * images * 4 * 4 / 3;
}

} // namespace

Preset parse_preset(const std::string& text, const fs::path& name) {
    toml::table table;
    try {
        table = toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw base::input_error(
            ExitCode::kBadInput, name, static_cast<int>(error.source().begin.line), "TOML",
            base::printable(error.description()), "a preset as in docs/texgen.md");
    }
    Preset preset;
    preset.name = "unnamed";
    for (const auto& [key, node] : table) {
        const toml::table* section = node.as_table();
        if (!section || !is_section(key.str())) {
            read_entry(preset, name, "", key, node);
            continue;
        }
        for (const auto& [inner, value] : *section)
            read_entry(preset, name, key.str(), inner, value);
    }
    check_preset(preset, name);
    return preset;
}

Preset load_preset(const fs::path& path) {
    return parse_preset(base::read_text(path, kMaxPresetBytes), path);
}

void override_preset(Preset& preset, const std::string& option, const std::string& key,
                     std::int64_t value) {
    for (const Field& field : preset_fields()) {
        if (field.full_key() != key)
            continue;
        const auto number = static_cast<double>(value);
        if (!(number >= field.low && number <= field.high))
            throw base::Error(ExitCode::kUsage, fmt::format("{}: found {}, expected {}", option,
                                                            value, field.expected()));
        preset.*std::get<std::int64_t Preset::*>(field.target) = value;
    }
}

void check_preset(const Preset& preset, const fs::path& origin) {
    const auto refuse = [&](ExitCode code, std::string_view what, const std::string& found,
                            const std::string& expected) {
        throw base::input_error(code, origin, 0, what, found, expected);
    };
    if (!std::has_single_bit(static_cast<std::uint64_t>(preset.size)))
        refuse(ExitCode::kBadInput, "texture.size", std::to_string(preset.size),
               "a power of two from 32 to 2048");
    if (preset.size >> (preset.levels - 1) < 16)
        refuse(ExitCode::kBadInput, "texture.levels", std::to_string(preset.levels),
               "at least 16 texels a side at the last level");
    const double tip =
        preset.lean_deg.high + preset.curvature_deg.high + preset.droop.high * kDroopDeg;
    if (tip > kMaxTipDeg)
        refuse(ExitCode::kBadInput, "blade.curvature_deg",
               fmt::format("{} degrees at the tip", tip),
               fmt::format("lean + curvature + droop x {} of at most {}", kDroopDeg, kMaxTipDeg));
    const double blades = preset.density_per_m2 * preset.side_m * preset.side_m;
    if (!(blades >= 1))
        refuse(ExitCode::kBadInput, "patch.density_per_m2",
               fmt::format("{:.3g} blades on the patch", blades), "at least 1");
    if (blades > kMaxBlades)
        refuse(ExitCode::kOverLimit, "patch.density_per_m2",
               fmt::format("{:.0f} blades on the patch", blades),
               fmt::format("at most {:.0f} (density x side squared)", kMaxBlades));
    if (border_width(preset) > preset.side_m / 4)
        refuse(
            ExitCode::kBadInput, "patch.side_m", fmt::format("{} m", preset.side_m),
            fmt::format("at least {:.2f} m: four times the reach of the longest blade and a margin",
                        4 * reach_bound(preset) / (1 - 4 * kMarginShare)));
    const double planes = static_cast<double>(preset.variants * shared::kPlanes);
    const double size = static_cast<double>(preset.size);
    const double layer_images = planes * static_cast<double>(preset.layers);
    const double slice_images = planes * 2 * static_cast<double>(preset.slices);
    const double rows = preset.length_m.high / preset.side_m * size + 4;
    const double bytes =
        std::max(array_bytes(size, size, layer_images), array_bytes(size, rows, slice_images));
    if (bytes > kMaxArrayBytes)
        refuse(ExitCode::kOverLimit, "texture",
               fmt::format("an array of {:.0f} MiB", bytes / (1 << 20)),
               "at most 1024 MiB: fewer texels, layers, slices or variants");
    if (std::max(layer_images, slice_images) > kMaxArrayLayers)
        refuse(ExitCode::kOverLimit, "texture",
               fmt::format("{:.0f} images in an array", std::max(layer_images, slice_images)),
               fmt::format("at most {:.0f}: fewer layers, slices or variants", kMaxArrayLayers));
}

fs::path find_preset(const std::string& argument, const std::vector<fs::path>& folders) {
    std::error_code ignored;
    if (fs::exists(argument, ignored))
        return argument;
    std::string known;
    for (const fs::path& folder : folders) {
        for (const std::string& name : {argument, argument + ".toml"})
            if (name.find('/') == std::string::npos && fs::is_regular_file(folder / name, ignored))
                return folder / name;
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().extension() == ".toml")
                names.push_back(entry.path().stem().string());
        std::ranges::sort(names);
        if (known.empty())
            known = fmt::format("{}", fmt::join(names, ", "));
    }
    throw base::input_error(ExitCode::kIo, argument, 0, "preset", "no such file",
                            "a path or a shipped preset: " +
                                (known.empty() ? "none found" : known));
}

double reach_bound(const Preset& preset) {
    // The longest blade, leaning and bending most, as a circular arc: chord L sin(b/2)/(b/2) at the
    // mean angle.
    constexpr double kRadians = std::numbers::pi / 180;
    const double lean = preset.lean_deg.high * kRadians;
    const double bend = (preset.curvature_deg.high + preset.droop.high * kDroopDeg) * kRadians;
    double reach = 0;
    for (int i = 1; i <= 64;
         ++i) { // an arc that passes the horizontal comes back: its farthest point counts
        const double s = i / 64.0;
        const double b = bend * s;
        const double chord =
            preset.length_m.high * s * (b > 1e-6 ? std::sin(b / 2) / (b / 2) : 1.0);
        reach = std::max(reach, chord * std::sin(std::min(lean + b / 2, std::numbers::pi / 2)));
    }
    return reach * 1.02 +
           preset.width_m.high / 2; // 2 %: a Bezier of that length is a little straighter
}

double border_width(const Preset& preset) {
    return reach_bound(preset) + kMarginShare * preset.side_m;
}

shared::GrassAppearance appearance(const Preset& preset) {
    const auto pack = [](const Colour& c, double a) {
        return shared::vec4(static_cast<float>(c[0]), static_cast<float>(c[1]),
                            static_cast<float>(c[2]), static_cast<float>(a));
    };
    shared::GrassAppearance look;
    look.root = pack(preset.root, preset.dry_share);
    look.tip = pack(preset.tip, preset.variation);
    look.dry = pack(preset.dry, preset.translucency);
    look.light = pack({preset.kd, preset.pd, preset.ks}, preset.ps);
    return look;
}

} // namespace sward::texgen
