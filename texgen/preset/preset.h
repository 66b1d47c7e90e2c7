// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/species.h"

namespace sward::texgen {

using scene::appearance;
using scene::Colour;
using scene::Element;
using scene::Species;
using Range = scene::Span;

inline constexpr int kFarRays = 32768;

/// B1: one height map a variant instead of an image a layer; kTop is top-weighted.
enum class HeightMap { kNone, kLinear, kTop };
inline constexpr std::array<const char*, 3> kHeightMapNames = {"none", "linear", "top"};

/// A grass set as a person writes it.
struct Preset {
    std::string name = "unnamed";
    std::int64_t seed = 1;

    double side_m = 2;            ///< period of the patch; memory and time grow with its square
    double density_per_m2 = 1400; ///< blades of all species
    std::int64_t variants = 4;    ///< patches that may stand side by side; more hide the period

    std::vector<Species> species{Species{}}; ///< at least one, at most shared::kMaxSpecies

    double floor_cover = 0.7; ///< share of the soil under moss, short leaves and litter
    Colour floor_moss{0.050, 0.078, 0.020};   ///< and short leaves
    Colour floor_litter{0.150, 0.118, 0.058}; ///< thatch, dead leaves

    /// Texels a side at level 0, a power of two; a texel should be as wide as a blade.
    std::int64_t size = 512;
    std::int64_t layers = 16; ///< shells at level 0
    std::int64_t slices = 16; ///< vertical slices an axis and patch side at level 0
    std::int64_t levels = 4;  ///< each halves size, layers and slices

    std::int64_t far_rays = kFarRays; ///< of a view of the far table; time grows with them, its
                                      ///< noise falls with their root

    HeightMap height_map = HeightMap::kNone;

    /// False: blades that cross the patch's edge are cut, and the set shows its joints. For tests.
    bool wrap = true;

    [[nodiscard]] double longest_m() const;
};

inline constexpr double kDroopDeg = 40;
inline constexpr std::int64_t kLeastLevelTexels = 16; ///< a side, of the last level

/// Reads and checks a preset. Throws base::Error that names file, line, key, value and range: kIo,
/// kBadInput, kOverLimit.
[[nodiscard]] Preset load_preset(const std::filesystem::path& path);
[[nodiscard]] Preset parse_preset(const std::string& text, const std::filesystem::path& name);

/// Sets one number as `--option VALUE` does, checked against the range of `key` ("texture.size").
/// Throws base::Error(kUsage).
void override_preset(Preset& preset, const std::string& option, const std::string& key,
                     std::int64_t value);

/// Checks what no single key shows: number of blades, reach against the patch side, memory.
/// `origin` leads the message. Throws base::Error: kBadInput or kOverLimit.
void check_preset(const Preset& preset, const std::filesystem::path& origin);

/// `argument` as a path, else the name of a shipped preset (".toml" may be left out) in one of
/// `folders`. Throws base::Error(kIo) that lists the shipped presets.
[[nodiscard]] std::filesystem::path find_preset(const std::string& argument,
                                                const std::vector<std::filesystem::path>& folders);

/// Upper bound of how far any blade of any species reaches sideways from its root, metres.
[[nodiscard]] double reach_bound(const Preset& preset);

/// Width of the rim inside which all variants are the same: reach plus a margin for the blades' own
/// neighbours.
[[nodiscard]] double border_width(const Preset& preset);

/// kHeightNone, kHeightLinear or kHeightTop.
[[nodiscard]] int height_coding(const Preset& preset);

/// Blades of each species on a patch: the shares of its blades, in whole numbers that add up.
[[nodiscard]] std::vector<std::size_t> species_counts(const Preset& preset);

} // namespace sward::texgen
