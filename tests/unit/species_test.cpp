// SPDX-License-Identifier: Apache-2.0
// What describes a species of grass: in [surface_grass] by the keys and ranges of a preset, and as
// older scenes spell them.
#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"

namespace sward::scene {
namespace {

const std::string kSurface = "[terrain]\nsurface = \"m.glb\"\n[surface_grass]\n";

SurfaceGrassSpec read(const std::string& text) {
    return parse_scene(kSurface + text, "s.toml").surface_grass;
}

std::string error_of(const std::string& text) {
    try {
        (void)read(text);
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ExitCode::kBadInput);
        return error.what();
    }
    return "no error";
}

TEST(SpeciesOfASurface, OlderKeysAreTheSections) {
    const SurfaceGrassSpec now = read(R"(
[surface_grass.tufts]
share = 0.75
radius_m = [0.03, 0.03]
blades = [26, 26]
[surface_grass.blade]
length_m = [0.07, 0.19]
width_m = [0.0012, 0.0024]
stiffness = [0.3, 0.6]
[surface_grass.colour]
root = [0.1, 0.2, 0.3]
tip = [0.2, 0.3, 0.4]
dry = [0.3, 0.4, 0.5]
dry_share = 0.12
variation = 0.3
[surface_grass.light]
ks = 0.5
translucency = 0.35
)");
    const SurfaceGrassSpec once = read(R"(
tuft_share = 0.75
tuft_radius_m = 0.03
tuft_blades = 26
blade_height_m = [0.07, 0.19]
blade_width_m = [0.0012, 0.0024]
stiffness = [0.3, 0.6]
root_colour = [0.1, 0.2, 0.3]
tip_colour = [0.2, 0.3, 0.4]
dry_colour = [0.3, 0.4, 0.5]
dry_share = 0.12
variation = 0.3
translucency = 0.35
[surface_grass.light]
ks = 0.5
)");
    for (const SurfaceGrassSpec* grass : {&now, &once}) {
        const Species& species = grass->species;
        EXPECT_EQ(species.tuft_share, 0.75);
        EXPECT_EQ(species.tuft_radius_m, (Span{0.03, 0.03}));
        EXPECT_EQ(species.tuft_blades, (Span{26, 26}));
        EXPECT_EQ(species.length_m, (Span{0.07, 0.19}));
        EXPECT_EQ(species.width_m, (Span{0.0012, 0.0024}));
        EXPECT_EQ(species.stiffness, (Span{0.3, 0.6}));
        EXPECT_EQ(species.root, (Colour{0.1, 0.2, 0.3}));
        EXPECT_EQ(species.tip, (Colour{0.2, 0.3, 0.4}));
        EXPECT_EQ(species.dry, (Colour{0.3, 0.4, 0.5}));
        EXPECT_EQ(species.dry_share, 0.12);
        EXPECT_EQ(species.variation, 0.3);
        EXPECT_EQ(species.ks, 0.5);
        EXPECT_EQ(species.translucency, 0.35);
    }
}

TEST(SpeciesOfASurface, RangesAreThePresets) {
    for (const SpeciesKey& key : species_keys()) {
        const auto text = [&](double value) {
            const std::string number = std::to_string(value);
            const std::size_t values = key.target.index() == 0 ? 1 : key.target.index() + 1;
            std::string all = number;
            for (std::size_t i = 1; i < values; ++i)
                all += ", " + number;
            return std::string("[surface_grass.") + key.section + "]\n" + key.key + " = " +
                   (values > 1 ? "[" + all + "]" : all) + "\n";
        };
        const std::string name = std::string("surface_grass.") + key.section;
        const std::string below = error_of(text(key.range.low - 1));
        if (below.find("unknown key") != std::string::npos) { // no mesh's: heads, curves
            EXPECT_EQ(error_of(text(key.range.low)), below) << name << key.key;
            continue;
        }
        EXPECT_NE(below.find(name + "." + key.key), std::string::npos) << below;
        EXPECT_NE(error_of(text(key.range.high + 1)).find("expected a number from"),
                  std::string::npos)
            << name << key.key;
        EXPECT_EQ(error_of(text(key.range.high)), "no error") << name << key.key;
    }
}

TEST(SpeciesOfASurface, RefusesWhatIsSaidTwiceOrOfNoMesh) {
    EXPECT_EQ(error_of("stiffness = [0.2, 0.4]\n[surface_grass.blade]\nstiffness = [0.2, 0.4]\n"),
              "s.toml:4: surface_grass.stiffness: found blade.stiffness beside it, expected one of "
              "the two");
    EXPECT_EQ(error_of("placement = \"single\"\n[surface_grass.tufts]\nshare = 0.5\n"),
              "s.toml:5: surface_grass.tufts: found no mixed placement, expected placement = "
              "\"mixed\" beside it");
    EXPECT_EQ(error_of("set = \"fur.toml\"\n[surface_grass.colour]\ntip = [0, 0, 0]\n"),
              "s.toml:5: surface_grass.colour: found set beside it, which describes the blades, "
              "expected one of the two");
    EXPECT_EQ(error_of("[surface_grass.blade]\nwidth = [1, 2]\n"),
              "s.toml:5: unknown key: found surface_grass.blade.width, expected "
              "surface_grass.blade.width_m");
    EXPECT_NE(error_of("[surface_grass.head]\nstalk = 1\n")
                  .find("s.toml:4: unknown key: found surface_grass.head, expected"),
              std::string::npos);
}

} // namespace
} // namespace sward::scene
