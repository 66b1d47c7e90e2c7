// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/grass_layout.h"

namespace sward::texgen {

/// Values drawn evenly between two ends, both included.
struct Range {
    double low = 0;
    double high = 0;
};

inline constexpr int kFarRays = 32768;

using Colour = std::array<double, 3>; ///< linear reflectance, Rec. 709 primaries

/// A kind of plant part as a person writes it (docs/texgen.md). Defaults are the shipped meadow's
/// grass.
struct Species {
    std::string name = "grass";
    /// What is drawn: "blade" tapers from its root; "seed_head", "leaf" and "flower" are strips
    /// with a head on a stalk, whose `head_from`, `stalk`, `fullness` and `taper` have other
    /// defaults.
    std::string element = "blade";
    double share = 1; ///< weight among the preset's species: its share of the blades

    double tuft_share = 0.55; ///< share of the blades that stand in tufts
    Range tuft_radius_m{0.03, 0.08};
    Range tuft_blades{8, 22};

    Range length_m{0.18, 0.36};  ///< along the curve
    Range width_m{0.004, 0.008}; ///< full width where it is widest
    double taper = 2;            ///< width falls as 1 - v^taper
    Range lean_deg{0, 16};       ///< of the root from the vertical
    Range curvature_deg{5, 34};  ///< angle between the tangents of root and tip
    Range stiffness{0.35, 0.8};  ///< 0 limp, 1 stiff: for the physics, no effect on the rest pose
    /// Weight's part of the curve: adds up to kDroopDeg for a blade of full length.
    Range droop{0, 0.35};

    double head_from = 1; ///< place along the blade where the head begins; 1: none
    double stalk = 1;     ///< width of the stalk over the head's
    double fullness = 1;  ///< of the head: 0.5 an ellipse, 1 a spindle, more: pointed

    Colour root{0.052, 0.088, 0.022};
    Colour tip{0.078, 0.152, 0.032};
    Colour dry{0.215, 0.175, 0.080};
    Colour head{0.16, 0.13, 0.06};
    double dry_share = 0.07;
    double variation = 0.45;

    double kd = 1;
    double pd = 1;
    double ks = 0.06;
    double ps = 18;
    double translucency = 0.45;
};

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

    /// B1: "linear" or "top" (top-weighted): one height map a variant instead of an image a layer.
    /// "none" otherwise.
    std::string height_map = "none";

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

[[nodiscard]] shared::GrassAppearance appearance(const Species& species);

/// Blades of each species on a patch: the shares of its blades, in whole numbers that add up.
[[nodiscard]] std::vector<std::size_t> species_counts(const Preset& preset);

} // namespace sward::texgen
