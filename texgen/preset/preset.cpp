// SPDX-License-Identifier: Apache-2.0
#include "texgen/preset/preset.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "scene/toml_reader.h"
#include "texgen/preset/preset_fields.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPresetBytes = 1 << 20;

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

/// Where keys stand: the preset's top level, or one of its [[species]].
enum class Scope { kPreset, kSpecies };

/// A key of a species without a section names one species, and so belongs into its entry alone.
bool stands_in(const Field& field, Scope scope) {
    return scope == Scope::kSpecies ? field.of_species()
                                    : !field.of_species() || !field.section.empty();
}

std::string nearest_key(std::string_view section, std::string_view key, Scope scope) {
    std::string best;
    int least = 1 << 20;
    const std::string full =
        section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
    for (const Field& field : preset_fields())
        for (const std::string_view name :
             {std::string_view(field.key), std::string_view(field.section)}) {
            if (name.empty() || !stands_in(field, scope))
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

bool clean_name(const std::string& text) {
    return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_';
    });
}

/// Where the values of a field go.
struct Into {
    Preset& preset;
    Species& species;
};

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
    std::string name() const {
        const std::string value = node.is_string() ? node.value<std::string>().value() : "";
        if (!clean_name(value))
            refuse();
        return value;
    }
    void put(const Into& into, std::string Preset::*target) const { into.preset.*target = name(); }
    void put(const Into& into, std::int64_t Preset::*target) const {
        if (!node.is_integer())
            refuse();
        into.preset.*target = static_cast<std::int64_t>(number(node));
    }
    void put(const Into& into, double Preset::*target) const { into.preset.*target = number(node); }
    void put(const Into& into, Colour Preset::*target) const { into.preset.*target = numbers<3>(); }
    void put(const Into& into, std::string Species::*target) const {
        into.species.*target = name();
    }
    void put(const Into& into, double Species::*target) const {
        into.species.*target = number(node);
    }
    void put(const Into& into, Range Species::*target) const {
        const auto [low, high] = numbers<2>();
        if (low > high)
            refuse();
        into.species.*target = {low, high};
    }
    void put(const Into& into, Colour Species::*target) const {
        into.species.*target = numbers<3>();
    }
    void read(const Into& into) const {
        std::visit([&](const auto& target) { put(into, target); }, field.target);
    }
};

/// All of a preset's tables.
class PresetReader {
public:
    explicit PresetReader(const fs::path& file) : file_(file) {}

    Preset read(const toml::table& table) {
        preset_.name = "unnamed";
        const toml::array* kinds = nullptr;
        for (const auto& [key, node] : table) {
            if (key.str() == "species") {
                kinds = node.as_array();
                if (!kinds || kinds->empty() || kinds->size() > shared::kMaxSpecies ||
                    !kinds->is_array_of_tables())
                    refuse(line_of(node), "species",
                           kinds ? fmt::format("{} entries", kinds->size()) : shown(node),
                           fmt::format("1 to {} [[species]] tables", shared::kMaxSpecies));
                continue;
            }
            entry(Scope::kPreset, preset_.species.front(), key, node);
        }
        if (kinds)
            species(*kinds);
        return std::move(preset_);
    }

private:
    [[noreturn]] void refuse(int line, std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(ExitCode::kBadInput, file_, line, what, found, expected);
    }

    /// The top level's species keys are every species' defaults; an element brings its own for the
    /// head.
    void species(const toml::array& kinds) {
        const Species common = preset_.species.front();
        preset_.species.clear();
        for (const toml::node& node : kinds) {
            const toml::table& table = *node.as_table();
            Species one = common;
            one.name = fmt::format("species{}", preset_.species.size());
            if (const toml::node* element = table.get("element"))
                apply_element(one, *element);
            for (const auto& [key, value] : table)
                entry(Scope::kSpecies, one, key, value);
            for (const Species& other : preset_.species)
                if (other.name == one.name)
                    refuse(line_of(node), "species.name", one.name + " a second time",
                           "a name of its own");
            preset_.species.push_back(one);
        }
    }

    void apply_element(Species& one, const toml::node& node) const {
        const std::string name = node.value<std::string>().value_or("");
        for (const Element& element : elements())
            if (element.name == name) {
                one.taper = element.taper;
                one.stalk = element.stalk;
                one.head_from = element.head_from;
                one.fullness = element.fullness;
                return;
            }
        refuse(line_of(node), "species.element", shown(node), "blade, seed_head, leaf or flower");
    }

    /// A key, or a section of keys.
    void entry(Scope scope, Species& one, const toml::key& key, const toml::node& node) {
        const toml::table* section = node.as_table();
        const bool known = std::ranges::any_of(preset_fields(), [&](const Field& field) {
            return !field.section.empty() && field.section == key.str() && stands_in(field, scope);
        });
        if (!section || !known)
            return value(scope, one, "", key, node);
        for (const auto& [inner, item] : *section)
            value(scope, one, key.str(), inner, item);
    }

    void value(Scope scope, Species& one, std::string_view section, const toml::key& key,
               const toml::node& node) {
        for (const Field& field : preset_fields())
            if (field.section == section && field.key == key.str() && stands_in(field, scope))
                return Reader{file_, field, node}.read({preset_, one});
        refuse(static_cast<int>(key.source().begin.line), "unknown key",
               key.str().empty() ? "\"\"" : base::printable(key.str()),
               fmt::format("a key such as {}", nearest_key(section, key.str(), scope)));
    }

    const fs::path& file_;
    Preset preset_;
};

} // namespace

Preset parse_preset(const std::string& text, const fs::path& name) {
    const toml::table table = scene::parse_toml(text, name);
    if (table.empty())
        base::log_warning(
            fmt::format("{}: nothing is set in it: this is plain meadow grass at its full size",
                        base::printable(name.string(), 300)));
    Preset preset = PresetReader(name).read(table);
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
