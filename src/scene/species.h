// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "scene/ranges.h"
#include "scene/toml_reader.h"
#include "shared/grass_layout.h"

namespace sward::scene {

using Colour = std::array<double, 3>; ///< linear reflectance, Rec. 709 primaries

/// What is drawn of a plant: a blade tapers from its root; the others are strips with a head on a
/// stalk.
enum class Element { kBlade, kSeedHead, kLeaf, kFlower };
inline constexpr std::array<const char*, 4> kElementNames = {"blade", "seed_head", "leaf",
                                                             "flower"};

/// A kind of plant part as a person writes it: in texgen's presets (docs/texgen.md), and of grass
/// on a mesh (docs/scene.md). Defaults are the shipped meadow's grass.
struct Species {
    std::string name = "grass";
    Element element = Element::kBlade;
    double share = 1; ///< weight among the preset's species: its share of the blades

    double tuft_share = 0.55; ///< share of the blades that stand in tufts
    Span tuft_radius_m{0.03, 0.08};
    Span tuft_blades{8, 22};

    Span length_m{0.18, 0.36};  ///< along the curve
    Span width_m{0.004, 0.008}; ///< full width where it is widest
    double taper = 2;           ///< width falls as 1 - v^taper
    Span lean_deg{0, 16};       ///< of the root from the vertical
    Span curvature_deg{5, 34};  ///< angle between the tangents of root and tip
    Span stiffness{0.35, 0.8};  ///< 0 limp, 1 stiff: for the physics, no effect on the rest pose
    /// Weight's part of the curve: adds up to kDroopDeg for a blade of full length.
    Span droop{0, 0.35};

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

    /// Makes it an element, with the head and the taper that come with it.
    void become(Element kind);
};

/// A key of a species' sections ([tufts], [blade], ...): the one list of what they are called, what
/// they may hold and where that goes.
struct SpeciesKey {
    using Target = std::variant<double Species::*, Span Species::*, Colour Species::*>;
    const char* section;
    const char* key;
    Target target;
    Range range;

    /// Reads it from `table`, where it stands under `name`.
    bool read(TableReader& table, const char* name, Species& species) const;
};
[[nodiscard]] std::span<const SpeciesKey> species_keys();
[[nodiscard]] const SpeciesKey& species_key(std::string_view section, std::string_view key);

/// Reads the sections that stand in `table`. A key that is not `wanted` is one that it does not
/// know.
void read_species(TableReader& table, Species& species, bool (*wanted)(const SpeciesKey&));

[[nodiscard]] shared::GrassAppearance appearance(const Species& species);

} // namespace sward::scene
