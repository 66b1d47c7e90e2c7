// SPDX-License-Identifier: Apache-2.0
#include "texgen/preset/preset.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
using scene::kShare;
using scene::SpeciesKey;
using scene::TableReader;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPresetBytes = 1 << 20;
constexpr double kMaxSeed = 9007199254740991.0; // 2^53 - 1: JSON readers keep it exact

/// A key of the preset's own: those of its species are scene/species.h's. The command line is held
/// to the same ranges.
struct PresetKey {
    using Target = std::variant<std::int64_t Preset::*, double Preset::*, Colour Preset::*>;
    const char* section; ///< empty: the top level
    const char* key;
    Target target;
    scene::Range range;

    [[nodiscard]] std::string full() const {
        return *section ? fmt::format("{}.{}", section, key) : key;
    }
};

const PresetKey kKeys[] = {
    {"", "seed", &Preset::seed, {0, kMaxSeed, ""}},
    {"patch", "side_m", &Preset::side_m, {0.1, 64, "m"}},
    {"patch", "density_per_m2", &Preset::density_per_m2, {1, 1000000, "blades per m2"}},
    {"patch", "variants", &Preset::variants, {1, 16, ""}},
    {"floor", "cover", &Preset::floor_cover, {0, 1, "of the soil"}},
    {"floor", "moss", &Preset::floor_moss, kShare},
    {"floor", "litter", &Preset::floor_litter, kShare},
    {"texture", "size", &Preset::size, {32, 2048, "texels, a power of two"}},
    {"texture", "layers", &Preset::layers, {2, 256, ""}},
    {"texture", "slices", &Preset::slices, {2, 256, "an axis"}},
    {"texture", "levels", &Preset::levels, {1, 4, ""}},
    {"texture", "far_rays", &Preset::far_rays, {256, 1048576, "of a view"}},
};

/// Puts a value of any kind where its key says.
struct Reader {
    TableReader& table;
    Preset& preset;
    const PresetKey& key;

    void operator()(std::int64_t Preset::*target) const {
        table.integer(key.key, preset.*target, key.range);
    }
    void operator()(double Preset::*target) const {
        table.number(key.key, preset.*target, key.range);
    }
    void operator()(Colour Preset::*target) const {
        table.three(key.key, preset.*target, key.range);
    }
};

void read_keys(TableReader& table, std::string_view section, Preset& preset) {
    for (const PresetKey& key : kKeys)
        if (section == key.section)
            std::visit(Reader{table, preset, key}, key.target);
}

bool any_key(const SpeciesKey& /*key*/) {
    return true;
}

/// What an unknown key at the top level may have meant.
std::vector<std::string> keys_of_sections() {
    std::vector<std::string> names{"texture.height_map"};
    for (const PresetKey& key : kKeys)
        if (*key.section)
            names.push_back(key.full());
    for (const SpeciesKey& key : scene::species_keys())
        names.push_back(fmt::format("{}.{}", key.section, key.key));
    return names;
}

/// [[species]]: each begins as the top level's species, its head as its element's.
void read_kinds(const toml::node& node, const fs::path& file, Preset& preset) {
    const toml::array* const kinds = node.as_array();
    if (!kinds || kinds->empty() || kinds->size() > shared::kMaxSpecies ||
        !kinds->is_array_of_tables())
        throw base::input_error(
            ExitCode::kBadInput, file, static_cast<int>(node.source().begin.line), "species",
            kinds ? fmt::format("{} entries", kinds->size()) : scene::described(node),
            fmt::format("1 to {} [[species]] tables", shared::kMaxSpecies));
    const Species common = preset.species.front();
    preset.species.clear();
    for (const toml::node& entry : *kinds) {
        TableReader table(*entry.as_table(), file, "species");
        Species one = common;
        one.name = fmt::format("species{}", preset.species.size());
        table.name("name", one.name);
        Element element = one.element;
        if (table.word("element", element, scene::kElementNames))
            one.become(element);
        table.number("share", one.share, {1e-6, 1e6, "(weight among the species)"});
        scene::read_species(table, one, any_key);
        table.finish();
        for (const Species& other : preset.species)
            if (other.name == one.name)
                throw table.error("name", one.name + " a second time", "a name of its own");
        preset.species.push_back(one);
    }
}

Preset read_preset(const toml::table& whole, const fs::path& file) {
    Preset preset;
    TableReader table(whole, file, "");
    table.name("name", preset.name);
    read_keys(table, "", preset);
    for (const char* section : {"patch", "floor", "texture"}) {
        std::optional<TableReader> inner = table.table(section);
        if (!inner)
            continue;
        read_keys(*inner, section, preset);
        if (std::string_view(section) == "texture")
            inner->word("height_map", preset.height_map, kHeightMapNames);
        inner->finish(keys_of_sections());
    }
    scene::read_species(table, preset.species.front(), any_key);
    table.knows("species");
    table.finish(keys_of_sections());
    if (const toml::node* kinds = whole.get("species"))
        read_kinds(*kinds, file, preset);
    return preset;
}

} // namespace

Preset parse_preset(const std::string& text, const fs::path& name) {
    const toml::table table = scene::parse_toml(text, name);
    if (table.empty())
        base::log_warning(
            fmt::format("{}: nothing is set in it: this is plain meadow grass at its full size",
                        base::printable(name.string(), 300)));
    Preset preset = read_preset(table, name);
    check_preset(preset, name);
    return preset;
}

Preset load_preset(const fs::path& path) {
    return parse_preset(base::read_text(path, kMaxPresetBytes), path);
}

void override_preset(Preset& preset, const std::string& option, const std::string& key,
                     std::int64_t value) {
    for (const PresetKey& one : kKeys) {
        if (one.full() != key)
            continue;
        const auto number = static_cast<double>(value);
        if (!(number >= one.range.low && number <= one.range.high))
            throw base::Error(ExitCode::kUsage, fmt::format("{}: found {}, expected {}", option,
                                                            value, scene::whole_number(one.range)));
        preset.*std::get<std::int64_t Preset::*>(one.target) = value;
    }
}

fs::path find_preset(const std::string& argument, const std::vector<fs::path>& folders) {
    std::error_code ignored;
    // A directory that is named like a preset does not hide it; a path to one is refused where it
    // is read.
    if (fs::exists(argument, ignored) &&
        (argument.find('/') != std::string::npos || !fs::is_directory(argument, ignored)))
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

} // namespace sward::texgen
