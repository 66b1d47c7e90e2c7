// SPDX-License-Identifier: Apache-2.0
#include "scene/species.h"

#include <algorithm>
#include <cassert>

namespace sward::scene {
namespace {

// Lengths, widths and tufts from a fur's hairs to the leaves on a mesh of any size.
const SpeciesKey kKeys[] = {
    {"tufts", "share", &Species::tuft_share, kShare},
    {"tufts", "radius_m", &Species::tuft_radius_m, {0, 10, "m"}},
    {"tufts", "blades", &Species::tuft_blades, {1, 1000, "blades"}},
    {"blade", "length_m", &Species::length_m, {0.001, 10, "m"}},
    {"blade", "width_m", &Species::width_m, {0.0001, 1, "m"}},
    {"blade", "taper", &Species::taper, {0.5, 20, ""}},
    {"blade", "lean_deg", &Species::lean_deg, {0, 80, "degrees"}},
    {"blade", "curvature_deg", &Species::curvature_deg, {0, 120, "degrees"}},
    {"blade", "stiffness", &Species::stiffness, kShare},
    {"blade", "droop", &Species::droop, kShare},
    {"head", "from", &Species::head_from, {0.05, 1, "(1: no head)"}},
    {"head", "stalk", &Species::stalk, {0.01, 1, "of the head's width"}},
    {"head", "fullness", &Species::fullness, {0.1, 4, ""}},
    {"colour", "root", &Species::root, kShare},
    {"colour", "tip", &Species::tip, kShare},
    {"colour", "dry", &Species::dry, kShare},
    {"colour", "head", &Species::head, kShare},
    {"colour", "dry_share", &Species::dry_share, kShare},
    {"colour", "variation", &Species::variation, kShare},
    {"light", "kd", &Species::kd, {0, 4, ""}},
    {"light", "pd", &Species::pd, {0.1, 100, ""}},
    {"light", "ks", &Species::ks, {0, 4, ""}},
    {"light", "ps", &Species::ps, {0.1, 1000, ""}},
    {"light", "translucency", &Species::translucency, kShare},
};

/// Puts a value of any kind where its key says.
struct Reader {
    TableReader& table;
    const char* name;
    Species& species;
    const Range& range;

    bool operator()(double Species::*target) const {
        return table.number(name, species.*target, range);
    }
    bool operator()(Span Species::*target) const {
        return table.span(name, species.*target, range);
    }
    bool operator()(Colour Species::*target) const {
        return table.three(name, species.*target, range);
    }
};

} // namespace

void Species::become(Element kind) {
    struct Head {
        double taper, stalk, from, fullness;
    };
    static constexpr std::array<Head, kElementNames.size()> kHeads = {
        {{2, 1, 1, 1}, {8, 0.3, 0.75, 1.0}, {8, 0.12, 0.3, 0.8}, {8, 0.08, 0.9, 0.5}}};
    const Head& own = kHeads.at(static_cast<std::size_t>(kind));
    element = kind;
    taper = own.taper;
    stalk = own.stalk;
    head_from = own.from;
    fullness = own.fullness;
}

bool SpeciesKey::read(TableReader& table, const char* name, Species& species) const {
    return std::visit(Reader{table, name, species, range}, target);
}

std::span<const SpeciesKey> species_keys() {
    return kKeys;
}

const SpeciesKey& species_key(std::string_view section, std::string_view key) {
    const auto found = std::ranges::find_if(
        kKeys, [&](const SpeciesKey& one) { return section == one.section && key == one.key; });
    assert(found != std::end(kKeys));
    return *found;
}

void read_species(TableReader& table, Species& species, bool (*wanted)(const SpeciesKey&)) {
    std::vector<std::string> elsewhere;
    for (const SpeciesKey& key : kKeys)
        if (wanted(key))
            elsewhere.push_back(table.full_name(std::string(key.section) + "." + key.key));
    for (const char* section : {"tufts", "blade", "head", "colour", "light"}) {
        const auto here = [&](const SpeciesKey& key) {
            return std::string_view(section) == key.section && wanted(key);
        };
        if (std::ranges::none_of(kKeys, here))
            continue;
        std::optional<TableReader> inner = table.table(section);
        if (!inner)
            continue;
        for (const SpeciesKey& key : kKeys)
            if (here(key))
                key.read(*inner, key.key, species);
        inner->finish(elsewhere);
    }
}

shared::GrassAppearance appearance(const Species& species) {
    const auto rgb = [](const Colour& c) {
        return shared::vec3(static_cast<float>(c[0]), static_cast<float>(c[1]),
                            static_cast<float>(c[2]));
    };
    shared::GrassAppearance look{};
    look.root = rgb(species.root);
    look.dry_share = static_cast<float>(species.dry_share);
    look.tip = rgb(species.tip);
    look.variation = static_cast<float>(species.variation);
    look.dry = rgb(species.dry);
    look.translucency = static_cast<float>(species.translucency);
    look.gloss = {static_cast<float>(species.kd), static_cast<float>(species.pd),
                  static_cast<float>(species.ks), static_cast<float>(species.ps)};
    look.head = rgb(species.head);
    look.outline = {static_cast<float>(species.taper), static_cast<float>(species.stalk),
                    static_cast<float>(species.head_from), static_cast<float>(species.fullness)};
    return look;
}

} // namespace sward::scene
