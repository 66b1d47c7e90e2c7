// SPDX-License-Identifier: Apache-2.0
// [[species]] in presets, and the shipped presets: that each is read, grows what it asks for and is
// calibrated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "grass_fixture.h"
#include "shared/blade.h"
#include "texgen/far/flat_rays.h"
#include "texgen/patch/canopy.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;
using shared::BladeRecord;

const fs::path kPresets = fs::path(SWARD_SOURCE_DIR) / "texgen/presets";

std::vector<std::string> shipped() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(kPresets))
        names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

Preset shipped(const std::string& name) {
    return load_preset(kPresets / (name + ".toml"));
}

TEST(Species, StartFromThePresetsTopLevelAndTheirElement) {
    const Preset preset = parse_preset(R"([blade]
length_m = [0.1, 0.2]
[colour]
dry_share = 0.25
[[species]]
[[species]]
name = "ear"
share = 3
element = "seed_head"
[species.blade]
width_m = [0.002, 0.003]
[species.head]
stalk = 0.5
)",
                                       "p.toml");
    ASSERT_EQ(preset.species.size(), 2u);
    const Species &plain = preset.species[0], &ear = preset.species[1];
    EXPECT_EQ(plain.name, "species0");
    EXPECT_EQ(plain.element, Element::kBlade);
    EXPECT_EQ(plain.head_from, 1);
    EXPECT_EQ(plain.width_m.low, Species{}.width_m.low);
    EXPECT_EQ(ear.name, "ear");
    EXPECT_EQ(ear.share, 3);
    EXPECT_EQ(ear.width_m.high, 0.003);
    EXPECT_EQ(ear.stalk, 0.5);      // its own
    EXPECT_EQ(ear.head_from, 0.75); // its element's
    EXPECT_EQ(ear.taper, 8);
    for (const Species& one : preset.species) { // the preset's
        EXPECT_EQ(one.length_m.high, 0.2);
        EXPECT_EQ(one.dry_share, 0.25);
    }
}

TEST(Species, ElementCountsWhereverItStands) {
    const char* before =
        "[[species]]\nelement = \"flower\"\nshare = 2\n[species.head]\nfrom = 0.6\n";
    const char* after = "[[species]]\nhead = { from = 0.6 }\nshare = 2\nelement = \"flower\"\n";
    for (const char* text : {before, after}) {
        const Species flower = parse_preset(text, "p.toml").species.front();
        EXPECT_EQ(flower.head_from, 0.6) << text;
        EXPECT_EQ(flower.fullness, 0.5) << text;
        EXPECT_EQ(flower.stalk, 0.08) << text;
    }
}

TEST(Species, RefusesNonsenseWithKeyValueAndRange) {
    struct Case {
        std::string text;
        std::vector<std::string> says;
    };
    std::string nine;
    for (int i = 0; i < 9; ++i)
        nine += "[[species]]\n";
    const std::vector<Case> cases = {
        {"species = []\n", {"p.toml:1", "species", "1 to 8"}},
        {"species = 3\n", {"p.toml:1", "species", "3", "1 to 8"}},
        {nine, {"species", "9 entries", "1 to 8"}},
        {"[[species]]\nelement = \"tree\"\n", {"p.toml:2", "species.element", "tree", "seed_head"}},
        {"[[species]]\nelement = 1\n", {"species.element", "1"}},
        {"[[species]]\nshare = 0\n", {"p.toml:2", "share", "0", "1e-06"}},
        {"[[species]]\nshare = nan\n", {"share", "nan"}},
        {"[[species]]\nname = \"a\"\n[[species]]\nname = \"a\"\n",
         {"species.name", "a second time"}},
        {"[[species]]\n[species.patch]\nside_m = 1\n", {"p.toml:2", "patch"}},
        {"[[species]]\n[species.blade]\nwidth = [1, 2]\n", {"p.toml:3", "width", "width_m"}},
        {"element = \"leaf\"\n", {"p.toml:1", "element"}},
        {"[[species]]\n[species.head]\nfrom = 0\n", {"p.toml:3", "head.from", "0.05 to 1"}},
        {"[[species]]\nname = \"tall\"\n[species.blade]\nlean_deg = [0, 80]\ncurvature_deg = [0, "
         "100]\n",
         {"blade.curvature_deg", "tall", "150"}},
    };
    for (const Case& c : cases) {
        const auto [code, text] = error_of([&] { (void)parse_preset(c.text, "p.toml"); });
        EXPECT_EQ(code, ExitCode::kBadInput) << c.text << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        for (const std::string& part : c.says)
            EXPECT_NE(text.find(part), std::string::npos)
                << c.text << "'" << part << "' not in: " << text;
    }
    // The parser would descend a level a dot, to the end of its stack.
    const auto [code, text] = error_of([] {
        std::string deep = "a";
        for (int i = 0; i < 60000; ++i)
            deep += ".a";
        (void)parse_preset(deep + " = 1", "p.toml");
    });
    EXPECT_EQ(code, base::ExitCode::kOverLimit);
    EXPECT_EQ(text.find("p.toml:1: dots in one line: found 60000"), 0u) << text;
}

/// Angle of the root's tangent from the vertical, degrees.
double lean_of(const BladeRecord& blade) {
    const shared::vec3 tangent =
        shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2), 0);
    return std::acos(std::clamp(static_cast<double>(tangent.y), -1.0, 1.0)) * 180 /
           std::numbers::pi;
}

void expect_in(double value, const Range& range, const std::string& what) {
    const double slack = 1e-3 * std::max(range.high, 1e-3);
    EXPECT_GE(value, range.low - slack) << what;
    EXPECT_LE(value, range.high + slack) << what;
}

/// Half widths along the outline: the blade's taper, or a stalk with a head on it that ends in a
/// point.
void expect_outline(const BladeRecord& blade, const Species& species, const Patch& patch) {
    const Outline outline = outline_of(blade, patch.looks);
    double widest = 0, widest_at = 0;
    for (int i = 0; i <= Outline::kSegments; ++i) {
        const double v = outline.v[i], stalk = species.stalk * (1 - std::pow(v, species.taper));
        if (v <= species.head_from) {
            EXPECT_NEAR(outline.half[i] / blade.v1.w, stalk, 1e-5) << species.name << " at " << v;
        }
        if (outline.half[i] > widest) {
            widest = outline.half[i];
            widest_at = v;
        }
    }
    const double middle = species.head_from < 1 ? (species.head_from + 1) / 2 : 0;
    EXPECT_NEAR(widest_at, middle, 0.1) << species.name;
    EXPECT_NEAR(widest, blade.v1.w, 0.1 * blade.v1.w) << species.name;
    EXPECT_NEAR(outline.half[Outline::kSegments], 0, 1e-6) << species.name;
}

class ShippedPreset : public testing::TestWithParam<std::string> {};

TEST_P(ShippedPreset, GrowsTheSpeciesItAsksFor) {
    Preset preset = shipped(GetParam());
    preset.variants = 1;
    const Patch patch = generate_patch(preset, 2);
    double shares = 0;
    for (const Species& one : preset.species)
        shares += one.share;
    for (int v = 0; v < patch.variants(); ++v) {
        const auto blades = patch.variant(v);
        std::vector<std::size_t> count(preset.species.size());
        for (std::size_t i = 0; i < blades.size(); ++i) {
            const std::size_t s = species_of(blades[i]);
            ASSERT_LT(s, preset.species.size());
            const Species& one = preset.species[s];
            if (count[s]++ == 0)
                expect_outline(blades[i], one, patch);
            expect_in(blades[i].shape.y, one.length_m, one.name + " length");
            expect_in(2 * blades[i].v1.w, one.width_m, one.name + " width");
            expect_in(lean_of(blades[i]), {one.lean_deg.low - 0.2, one.lean_deg.high + 0.2},
                      one.name + " lean");
            expect_in(blades[i].v2.w, one.stiffness, one.name + " stiffness");
        }
        const double asked = preset.density_per_m2 * preset.side_m * preset.side_m;
        EXPECT_NEAR(static_cast<double>(blades.size()), asked, 0.5);
        for (std::size_t s = 0; s < count.size(); ++s)
            EXPECT_NEAR(static_cast<double>(count[s]), asked * preset.species[s].share / shares,
                        1.0)
                << preset.species[s].name;
    }
}

TEST_P(ShippedPreset, IsCalibratedWithinThreePoints) {
    base::set_verbosity(base::Verbosity::kQuiet);
    Preset preset = shipped(GetParam());
    preset.size = 128;
    preset.variants = 1;
    preset.levels = 1;
    preset.far_rays = 4096; // 0.8 points
    const grass::GrassSet set = bake_set(preset, {.threads = 2, .volume = false, .preview = false});
    int rows = 0;
    for (const grass::FarRow& row : set.far) {
        if (row.elevation_deg == 82.5f || row.elevation_deg < 5)
            continue;
        ++rows;
        const FlatUse use{row.share_at(0), row.slice_share};
        EXPECT_NEAR(flat_coverage(set, 0, row.elevation_deg, use, 4096).coverage, row.coverage,
                    0.03)
            << row.elevation_deg;
        // Shells and slices whole cover too much: there is something to calibrate, where there is
        // room for it (reeds: 0.98).
        if (row.elevation_deg == 45 && row.coverage < 0.95f) {
            EXPECT_GT(flat_coverage(set, 0, 45, {1, row.slice_share}, 4096).coverage,
                      row.coverage + 0.03);
        }
    }
    EXPECT_EQ(rows, 8);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPreset, testing::ValuesIn(shipped()), [](const auto& of) {
    std::string name = of.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

TEST(ShippedPresets, AreTheSevenAndNamedLikeTheirFiles) {
    const std::vector<std::string> names = shipped();
    for (const char* name : {"meadow", "lawn", "wheat", "heath", "dry-steppe", "reeds", "fur"})
        EXPECT_TRUE(std::ranges::count(names, name)) << name;
    for (const std::string& name : names) {
        const Preset preset = shipped(name);
        EXPECT_EQ(preset.name, name);
        EXPECT_LE(border_width(preset), preset.side_m / 4);
    }
}

} // namespace
} // namespace sward::texgen
