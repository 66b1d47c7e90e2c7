// SPDX-License-Identifier: Apache-2.0
// What of a preset no single key shows: its sizes, and whether they are within the limits.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <ranges>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
namespace fs = std::filesystem;

constexpr double kMaxBlades = 200000;      // a variant: the renderer's lists and the ranking's time
constexpr double kMaxArrayBytes = 1 << 30; // robustness: one texture array
constexpr double kMaxArrayLayers = 2048;
constexpr double kMarginShare = 0.02; // of the side, on top of the reach
constexpr double kMaxTipDeg = 150;    // a curve that rolls up would leave its own slab order

double array_bytes(double width, double height, double images) {
    return width * height * images * 4 * 4 / 3;
}

/// The longest blade, leaning and bending most, as a circular arc: chord L sin(b/2)/(b/2) at the
/// mean angle.
double species_reach(const Species& species) {
    const double lean = species.lean_deg.high * base::kDegree;
    const double bend =
        (species.curvature_deg.high + species.droop.high * kDroopDeg) * base::kDegree;
    double reach = 0;
    for (int i = 1; i <= 64;
         ++i) { // an arc that passes the horizontal comes back: its farthest point counts
        const double s = i / 64.0;
        const double b = bend * s;
        const double chord =
            species.length_m.high * s * (b > 1e-6 ? std::sin(b / 2) / (b / 2) : 1.0);
        reach = std::max(reach, chord * std::sin(std::min(lean + b / 2, std::numbers::pi / 2)));
    }
    return reach * 1.02 +
           species.width_m.high / 2; // 2 %: a Bezier of that length is a little straighter
}

using Refuse = std::function<void(ExitCode, std::string_view, const std::string& found,
                                  const std::string& expected)>;

/// Arrays of textures within what is allowed.
void check_arrays(const Preset& preset, const Refuse& refuse) {
    const double planes = static_cast<double>(preset.variants * shared::kPlanes);
    const double size = static_cast<double>(preset.size);
    const double layer_images =
        planes *
        static_cast<double>(height_coding(preset) == shared::kHeightNone ? preset.layers : 1);
    const double slice_images = planes * 2 * static_cast<double>(preset.slices);
    const double rows = preset.longest_m() / preset.side_m * size + 4;
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

} // namespace

void check_preset(const Preset& preset, const fs::path& origin) {
    const Refuse refuse = [&](ExitCode code, std::string_view what, const std::string& found,
                              const std::string& expected) {
        throw base::input_error(code, origin, 0, what, found, expected);
    };
    if (!std::has_single_bit(static_cast<std::uint64_t>(preset.size)))
        refuse(ExitCode::kBadInput, "texture.size", std::to_string(preset.size),
               "a power of two from 32 to 2048");
    if (preset.size >> (preset.levels - 1) < kLeastLevelTexels)
        refuse(ExitCode::kBadInput, "texture.levels", std::to_string(preset.levels),
               "at least 16 texels a side at the last level");
    for (const Species& species : preset.species) {
        const double tip =
            species.lean_deg.high + species.curvature_deg.high + species.droop.high * kDroopDeg;
        if (tip > kMaxTipDeg)
            refuse(
                ExitCode::kBadInput, "blade.curvature_deg",
                fmt::format("{} degrees at the tip of {}", tip, species.name),
                fmt::format("lean + curvature + droop x {} of at most {}", kDroopDeg, kMaxTipDeg));
    }
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
    for (const Species& species : preset.species)
        if (border_width(preset) + species.tuft_radius_m.high > 0.45 * preset.side_m)
            refuse(
                ExitCode::kBadInput, "tufts.radius_m",
                fmt::format("{} m in {}", species.tuft_radius_m.high, species.name),
                fmt::format(
                    "less than {:.2f} m: tufts and the reach of the blades must leave an interior",
                    0.45 * preset.side_m - border_width(preset)));
    check_arrays(preset, refuse);
}

double reach_bound(const Preset& preset) {
    return std::ranges::max(preset.species | std::views::transform(species_reach));
}

double border_width(const Preset& preset) {
    return reach_bound(preset) + kMarginShare * preset.side_m;
}

double Preset::longest_m() const {
    return std::ranges::max(species, {}, [](const Species& s) { return s.length_m.high; })
        .length_m.high;
}

std::vector<std::size_t> species_counts(const Preset& preset) {
    const double total = std::round(preset.density_per_m2 * preset.side_m * preset.side_m);
    double sum = 0;
    for (const Species& species : preset.species)
        sum += species.share;
    std::vector<std::size_t> counts;
    double running = 0;
    std::size_t given = 0;
    for (const Species& species : preset.species) { // by running sum, so that rounding adds up
        running += species.share / sum;
        const auto until = static_cast<std::size_t>(std::llround(total * std::min(running, 1.0)));
        counts.push_back(until - given);
        given = until;
    }
    return counts;
}

int height_coding(const Preset& preset) {
    return preset.height_map == HeightMap::kLinear ? shared::kHeightLinear
           : preset.height_map == HeightMap::kTop  ? shared::kHeightTop
                                                   : shared::kHeightNone;
}

} // namespace sward::texgen
