// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace sward::scene {

/// What lies under the grass, or bare.
enum class GroundKind { kSoil, kRock, kSand, kGravel, kAsphalt, kWater };
inline constexpr std::array<const char*, 6> kGroundNames = {"soil",   "rock",    "sand",
                                                            "gravel", "asphalt", "water"};

/// What stands and lies where a landcover has a class.
struct LandClass {
    LandClass() = default;
    LandClass(double of_grass) : density(of_grass) {} ///< as `10 = 0.8` has it

    double density = 0; ///< of the grass, 0..1
    double height = 1;  ///< factor on its height
    double dryness = 0; ///< added to the sward's own, -1 lush .. 1 dry
    GroundKind ground = GroundKind::kSoil;

    bool operator==(const LandClass&) const = default;
    /// Does a density say all of it?
    [[nodiscard]] bool plain() const {
        return height == 1 && dryness == 0 && ground == GroundKind::kSoil;
    }
};

/// Areas or lines of a file that are burnt over the classes.
struct LandFeature {
    std::filesystem::path file;
    std::string layer; ///< empty: its first
    std::string where; ///< on its attributes, in OGR's SQL; empty: all
    LandClass look;
    double width_m = 0; ///< of lines; 0: areas
};

} // namespace sward::scene
