// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <fmt/format.h>

#include "scene/scene_sections.h"

namespace sward::scene {
namespace {

/// What the keys of a species' sections were called here when they stood in [surface_grass] itself;
/// such scenes are still read.
struct OnceCalled {
    const char* name;
    const char *section, *key;
};
constexpr OnceCalled kOnceCalled[] = {
    {"tuft_share", "tufts", "share"},       {"tuft_blades", "tufts", "blades"},
    {"tuft_radius_m", "tufts", "radius_m"}, {"blade_height_m", "blade", "length_m"},
    {"blade_width_m", "blade", "width_m"},  {"stiffness", "blade", "stiffness"},
    {"root_colour", "colour", "root"},      {"tip_colour", "colour", "tip"},
    {"dry_colour", "colour", "dry"},        {"dry_share", "colour", "dry_share"},
    {"variation", "colour", "variation"},   {"translucency", "light", "translucency"},
};

/// How a mesh's blade is drawn and bends is the mesh's own: its outline is `shape`, and it hangs by
/// gravity as the surface lies under it.
bool is_of_surface(const SpeciesKey& key) {
    const std::string_view section = key.section, name = key.key;
    if (section == "blade")
        return name == "length_m" || name == "width_m" || name == "stiffness";
    return section != "head" && name != "head";
}

/// With a set, what describes blades is the set's.
void refuse_beside_set(const TableReader& table) {
    const auto refuse = [&](const char* key) {
        if (table.has(key))
            throw table.error(key, "set beside it, which describes the blades", "one of the two");
    };
    for (const char* key :
         {"density_per_m2", "placement", "tufts", "tuft_gather", "blade", "colour", "light",
          "droop", "lean", "shape", "thin_out_m", "tip_tau", "teeth", "tooth_depth", "seed"})
        refuse(key);
    for (const OnceCalled& once : kOnceCalled)
        refuse(once.name);
}

/// One number for both ends, as the tufts' keys had it.
void read_both(TableReader& table, const OnceCalled& once, const Range& range, Span& value) {
    if (double given = 0; table.number(once.name, given, range))
        value = {given, given};
}

void read_once_called(TableReader& table, Species& species) {
    for (const OnceCalled& once : kOnceCalled) {
        const SpeciesKey& key = species_key(once.section, once.key);
        const auto* const span = std::get_if<Span Species::*>(&key.target);
        if (span && std::string_view(once.section) == "tufts")
            read_both(table, once, key.range, species.**span);
        else
            key.read(table, once.name, species);
        if (table.has(once.name) && table.holds(once.section, once.key))
            throw table.error(once.name, fmt::format("{}.{} beside it", once.section, once.key),
                              "one of the two");
    }
}

} // namespace

void read_surface_grass(TableReader table, SurfaceGrassSpec& grass, GrassSpec& of_set) {
    if (table.text("set", grass.set)) {
        of_set.set = grass.set;
        refuse_beside_set(table);
    }
    if (table.number("density", of_set.density, kShare) && grass.set.empty())
        throw table.error("density", "no set", "density_per_m2, or a set beside it");
    table.number("density_per_m2", grass.density_per_m2, {0.01, 1e6, "blades per m2"});
    table.word("placement", grass.placement, kPlacementNames);
    read_once_called(table, grass.species);
    read_species(table, grass.species, is_of_surface);
    table.number("tuft_gather", grass.tuft_gather, {-1, 1, ""});
    table.number("slope_deg", grass.slope_deg, {0, 180, "degrees"});
    table.number("droop", grass.droop, {0, 2, ""});
    table.number("lean", grass.lean, {0, 3, ""});
    table.word("shape", grass.shape, kBladeShapeNames);
    table.number("thin_out_m", grass.thin_out_m, {0, 1e6, "m"});
    table.number("tip_tau", grass.tip_tau, {0, 0.99, ""});
    table.integer("teeth", grass.teeth, 1, 12);
    table.number("tooth_depth", grass.tooth_depth, kShare);
    read_colour(table, "ground_colour", grass.ground_colour);
    read_colour(table, "bare_colour", grass.bare_colour);
    table.integer("seed", grass.seed, 0, 2147483647);
    table.finish();
    if (grass.placement == Placement::kMixed)
        return;
    const bool once = table.has("tuft_share");
    if (once || table.holds("tufts", "share"))
        throw table.error(once ? "tuft_share" : "tufts", "no mixed placement",
                          "placement = \"mixed\" beside it");
}

} // namespace sward::scene
