// SPDX-License-Identifier: Apache-2.0
#include "texgen/preset/preset_fields.h"

#include <fmt/format.h>

namespace sward::texgen {
namespace {

constexpr double kMaxSeed = 9007199254740991.0; // 2^53 - 1: JSON readers keep it exact

const Field kFields[] = {
    {"", "name", &Preset::name, 1, 64, "letters, digits, - and _"},
    {"", "seed", &Preset::seed, 0, kMaxSeed, ""},
    {"patch", "side_m", &Preset::side_m, 0.1, 64, "metres"},
    {"patch", "density_per_m2", &Preset::density_per_m2, 1, 1000000, "blades per square metre"},
    {"patch", "variants", &Preset::variants, 1, 16, ""},
    {"floor", "cover", &Preset::floor_cover, 0, 1, "of the soil"},
    {"floor", "moss", &Preset::floor_moss, 0, 1, "linear reflectance"},
    {"floor", "litter", &Preset::floor_litter, 0, 1, "linear reflectance"},
    {"", "name", &Species::name, 1, 64, "letters, digits, - and _"},
    {"", "element", &Species::element, 1, 16, "letters: blade, seed_head, leaf or flower"},
    {"", "share", &Species::share, 1e-6, 1e6, "(weight among the species)"},
    {"tufts", "share", &Species::tuft_share, 0, 1, ""},
    {"tufts", "radius_m", &Species::tuft_radius_m, 0.001, 2, "metres"},
    {"tufts", "blades", &Species::tuft_blades, 1, 1000, "blades"},
    {"blade", "length_m", &Species::length_m, 0.005, 5, "metres"},
    {"blade", "width_m", &Species::width_m, 0.0002, 0.1, "metres"},
    {"blade", "taper", &Species::taper, 0.5, 20, ""},
    {"blade", "lean_deg", &Species::lean_deg, 0, 80, "degrees"},
    {"blade", "curvature_deg", &Species::curvature_deg, 0, 120, "degrees"},
    {"blade", "stiffness", &Species::stiffness, 0, 1, ""},
    {"blade", "droop", &Species::droop, 0, 1, ""},
    {"head", "from", &Species::head_from, 0.05, 1, "(1: no head)"},
    {"head", "stalk", &Species::stalk, 0.01, 1, "of the head's width"},
    {"head", "fullness", &Species::fullness, 0.1, 4, ""},
    {"colour", "root", &Species::root, 0, 1, "linear reflectance"},
    {"colour", "tip", &Species::tip, 0, 1, "linear reflectance"},
    {"colour", "dry", &Species::dry, 0, 1, "linear reflectance"},
    {"colour", "head", &Species::head, 0, 1, "linear reflectance"},
    {"colour", "dry_share", &Species::dry_share, 0, 1, ""},
    {"colour", "variation", &Species::variation, 0, 1, ""},
    {"light", "kd", &Species::kd, 0, 4, ""},
    {"light", "pd", &Species::pd, 0.1, 100, ""},
    {"light", "ks", &Species::ks, 0, 4, ""},
    {"light", "ps", &Species::ps, 0.1, 1000, ""},
    {"light", "translucency", &Species::translucency, 0, 1, ""},
    {"texture", "size", &Preset::size, 32, 2048, "texels, a power of two"},
    {"texture", "layers", &Preset::layers, 2, 256, ""},
    {"texture", "slices", &Preset::slices, 2, 256, "an axis"},
    {"texture", "height_map", &Preset::height_map, 1, 8, "letters: none, linear or top"},
    {"texture", "levels", &Preset::levels, 1, 4, ""},
    {"texture", "far_rays", &Preset::far_rays, 256, 1048576, "of a view"},
};

constexpr Element kElements[] = {
    {"blade", 2, 1, 1, 1},
    {"seed_head", 8, 0.3, 0.75, 1.0},
    {"leaf", 8, 0.12, 0.3, 0.8},
    {"flower", 8, 0.08, 0.9, 0.5},
};

} // namespace

std::string Field::full_key() const {
    return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

std::string Field::expected() const {
    static constexpr std::string_view kKinds[] = {"text of",
                                                  "a whole number from",
                                                  "a number from",
                                                  "[r, g, b], three numbers from",
                                                  "text of",
                                                  "a number from",
                                                  "[low, high], two rising numbers from",
                                                  "[r, g, b], three numbers from"};
    return fmt::format("{} {} to {}{}{}", kKinds[target.index()], low, high,
                       unit.empty() ? "" : " ", unit);
}

std::span<const Field> preset_fields() {
    return kFields;
}

std::span<const Element> elements() {
    return kElements;
}

} // namespace sward::texgen
