// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/scene_sections.h"

namespace sward::scene {
namespace {

constexpr std::array<std::string_view, 3> kPlacements = {"single", "tufts", "mixed"};
constexpr std::array<std::string_view, 5> kShapes = {"quad", "triangle", "quadratic",
                                                     "triangle-tip", "dandelion"};

/// The number of the word under `key` among `words`; `value` where there is none.
template<std::size_t n>
int read_word(TableReader& table, const char* key, const std::array<std::string_view, n>& words,
              int value) {
    std::string found;
    if (!table.name(key, found))
        return value;
    for (std::size_t i = 0; i < n; ++i)
        if (found == words[i])
            return static_cast<int>(i);
    throw table.error(key, fmt::format("\"{}\"", found),
                      fmt::format("one of {}", fmt::join(words, ", ")));
}

/// [from, to], rising or equal.
void read_span(TableReader& table, const char* key, glm::dvec2& value, const Range& range) {
    std::vector<double> given;
    if (!table.numbers(key, given, {range, range}))
        return;
    if (given[0] > given[1])
        throw table.error(key, fmt::format("[{}, {}]", given[0], given[1]), "the lesser first");
    value = {given[0], given[1]};
}

/// With a set, what describes blades is the set's.
void refuse_beside_set(const TableReader& table) {
    for (const char* key :
         {"density_per_m2", "placement",      "tuft_share",    "tuft_blades", "tuft_radius_m",
          "tuft_gather",    "blade_height_m", "blade_width_m", "stiffness",   "droop",
          "lean",           "shape",          "thin_out_m",    "tip_tau",     "teeth",
          "tooth_depth",    "root_colour",    "tip_colour",    "dry_colour",  "dry_share",
          "variation",      "translucency",   "seed"})
        if (table.has(key))
            throw table.error(key, "set beside it, which describes the blades", "one of the two");
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
    grass.placement = static_cast<Placement>(
        read_word(table, "placement", kPlacements, static_cast<int>(grass.placement)));
    table.number("tuft_share", grass.tuft_share, kShare);
    table.integer("tuft_blades", grass.tuft_blades, 1, 1000);
    table.number("tuft_radius_m", grass.tuft_radius_m, {0, 10, "m"});
    table.number("tuft_gather", grass.tuft_gather, {-1, 1, ""});
    table.number("slope_deg", grass.slope_deg, {0, 180, "degrees"});
    read_span(table, "blade_height_m", grass.blade_height_m, {0.001, 10, "m"});
    read_span(table, "blade_width_m", grass.blade_width_m, {0.0001, 1, "m"});
    read_span(table, "stiffness", grass.stiffness, {0.02, 1, ""});
    table.number("droop", grass.droop, {0, 2, ""});
    table.number("lean", grass.lean, {0, 3, ""});
    grass.shape =
        static_cast<BladeShape>(read_word(table, "shape", kShapes, static_cast<int>(grass.shape)));
    table.number("thin_out_m", grass.thin_out_m, {0, 1e6, "m"});
    table.number("tip_tau", grass.tip_tau, {0, 0.99, ""});
    table.integer("teeth", grass.teeth, 1, 12);
    table.number("tooth_depth", grass.tooth_depth, kShare);
    read_colour(table, "root_colour", grass.root_colour);
    read_colour(table, "tip_colour", grass.tip_colour);
    read_colour(table, "dry_colour", grass.dry_colour);
    table.number("dry_share", grass.dry_share, kShare);
    table.number("variation", grass.variation, kShare);
    table.number("translucency", grass.translucency, kShare);
    read_colour(table, "ground_colour", grass.ground_colour);
    read_colour(table, "bare_colour", grass.bare_colour);
    table.integer("seed", grass.seed, 0, 2147483647);
    table.finish();
    if (table.has("tuft_share") && grass.placement != Placement::kMixed)
        throw table.error("tuft_share", "no mixed placement", "placement = \"mixed\" beside it");
}

} // namespace sward::scene
