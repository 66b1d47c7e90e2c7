// SPDX-License-Identifier: Apache-2.0
#include "texgen/preset_fields.h"

#include <fmt/format.h>

namespace sward::texgen {
namespace {

constexpr double kMaxSeed = 9007199254740991.0; // 2^53 - 1: JSON readers keep it exact

const Field kFields[] = {
    {"", "name", &Preset::name, 1, 64, "letters, digits, - and _"},
    {"", "seed", &Preset::seed, 0, kMaxSeed, ""},
    {"patch", "side_m", &Preset::side_m, 0.1, 64, "metres"},
    {"patch", "density_per_m2", &Preset::density_per_m2, 1, 50000, "blades per square metre"},
    {"patch", "variants", &Preset::variants, 1, 16, ""},
    {"tufts", "share", &Preset::tuft_share, 0, 1, ""},
    {"tufts", "radius_m", &Preset::tuft_radius_m, 0.001, 2, "metres"},
    {"tufts", "blades", &Preset::tuft_blades, 1, 1000, "blades"},
    {"blade", "length_m", &Preset::length_m, 0.005, 5, "metres"},
    {"blade", "width_m", &Preset::width_m, 0.0002, 0.1, "metres"},
    {"blade", "lean_deg", &Preset::lean_deg, 0, 80, "degrees"},
    {"blade", "curvature_deg", &Preset::curvature_deg, 0, 120, "degrees"},
    {"blade", "stiffness", &Preset::stiffness, 0, 1, ""},
    {"blade", "droop", &Preset::droop, 0, 1, ""},
    {"colour", "root", &Preset::root, 0, 1, "linear reflectance"},
    {"colour", "tip", &Preset::tip, 0, 1, "linear reflectance"},
    {"colour", "dry", &Preset::dry, 0, 1, "linear reflectance"},
    {"colour", "dry_share", &Preset::dry_share, 0, 1, ""},
    {"colour", "variation", &Preset::variation, 0, 1, ""},
    {"light", "kd", &Preset::kd, 0, 4, ""},
    {"light", "pd", &Preset::pd, 0.1, 100, ""},
    {"light", "ks", &Preset::ks, 0, 4, ""},
    {"light", "ps", &Preset::ps, 0.1, 1000, ""},
    {"light", "translucency", &Preset::translucency, 0, 1, ""},
    {"texture", "size", &Preset::size, 32, 2048, "texels, a power of two"},
    {"texture", "layers", &Preset::layers, 2, 256, ""},
    {"texture", "slices", &Preset::slices, 2, 256, "an axis"},
    {"texture", "levels", &Preset::levels, 1, 4, ""},
};

} // namespace

std::string Field::full_key() const {
    return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

std::string Field::expected() const {
    static constexpr std::string_view kKinds[] = {"text of", "a whole number from", "a number from",
                                                  "[low, high], two rising numbers from",
                                                  "[r, g, b], three numbers from"};
    return fmt::format("{} {} to {}{}{}", kKinds[target.index()], low, high,
                       unit.empty() ? "" : " ", unit);
}

std::span<const Field> preset_fields() {
    return kFields;
}

} // namespace sward::texgen
