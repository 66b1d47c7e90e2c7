// SPDX-License-Identifier: Apache-2.0
// Grass sets from the preset to the directory: what texgen draws is held to rays through the
// blades, what it writes to what is read back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>
#include <random>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "grass/blades_glb.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "texgen/far_level.h"
#include "texgen/flat_rays.h"
#include "texgen/preset.h"
#include "texgen/rays.h"
#include "texgen/volume.h"
#include "texgen/writer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;
using shared::BladeRecord;

Preset small_meadow() {
    Preset preset;
    preset.name = "small";
    preset.density_per_m2 = 300;
    preset.variants = 3;
    preset.size = 256;
    preset.layers = 8;
    preset.slices = 8;
    preset.levels = 3;
    return preset;
}

const grass::GrassSet& small_set() {
    static const grass::GrassSet set = [] {
        base::set_verbosity(base::Verbosity::kQuiet);
        return bake_set(small_meadow(), {.threads = 2, .volume = false, .preview = false});
    }();
    return set;
}

Patch small_patch() {
    return generate_patch(small_meadow(), 2);
}

/// Runs `act` and returns the error's code and text.
template<typename Act> std::pair<ExitCode, std::string> error_of(const Act& act) {
    try {
        act();
    } catch (const base::Error& error) {
        return {error.code(), error.what()};
    }
    return {ExitCode::kDone, "no error"};
}

double mean_coverage(const grass::TextureArray& array, int image, std::size_t mip) {
    const std::size_t bytes = array.mips[mip].size() / static_cast<std::size_t>(array.layers);
    double sum = 0;
    for (std::size_t t = 0; t < bytes; t += 4)
        sum += array.mips[mip][static_cast<std::size_t>(image) * bytes + t];
    return sum / 255.0 / (static_cast<double>(bytes) / 4);
}

class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / fmt::format("sward-grass-test-{}", ::getpid())) {
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

// ---- preset

TEST(Preset, ShippedOnesLoad) {
    for (const char* name : {"meadow", "lawn"}) {
        const Preset preset = load_preset(fs::path(SWARD_SOURCE_DIR) / "texgen/presets" /
                                          (std::string(name) + ".toml"));
        EXPECT_EQ(preset.name, name);
        EXPECT_LE(border_width(preset), preset.side_m / 4);
    }
}

TEST(Preset, RefusesNonsenseWithKeyValueAndRange) {
    struct Case {
        const char* text;
        ExitCode code;
        std::vector<std::string> says;
    };
    const std::vector<Case> cases = {
        {"name = \"a\"\n[patch]\ndensity_per_m = 5\n",
         ExitCode::kBadInput,
         {"p.toml:3", "density_per_m", "patch.density_per_m2"}},
        {"[blades]\nlength_m = [1, 2]\n", ExitCode::kBadInput, {"p.toml:1", "blades", "blade"}},
        {"[patch]\ndensity_per_m2 = -5\n",
         ExitCode::kBadInput,
         {"p.toml:2", "patch.density_per_m2", "-5", "1 to 50000"}},
        {"[patch]\ndensity_per_m2 = nan\n", ExitCode::kBadInput, {"density_per_m2", "nan"}},
        {"[patch]\nside_m = inf\n", ExitCode::kBadInput, {"side_m", "inf"}},
        {"[patch]\ndensity_per_m2 = 50000\nside_m = 60\n",
         ExitCode::kOverLimit,
         {"blades", "200000"}},
        {"[texture]\nsize = 0\n", ExitCode::kBadInput, {"texture.size", "32 to 2048"}},
        {"[texture]\nsize = 16385\n", ExitCode::kBadInput, {"texture.size", "16385"}},
        {"[texture]\nsize = 300\n", ExitCode::kBadInput, {"texture.size", "power of two"}},
        {"[texture]\nsize = 512.5\n", ExitCode::kBadInput, {"texture.size", "whole"}},
        {"[texture]\nlayers = 2049\n", ExitCode::kBadInput, {"texture.layers", "2049"}},
        {"[texture]\nsize = 2048\nlayers = 256\n", ExitCode::kOverLimit, {"texture", "1024 MiB"}},
        {"[blade]\nlength_m = [0.4, 0.2]\n", ExitCode::kBadInput, {"blade.length_m", "rising"}},
        {"[blade]\nlength_m = 0.3\n", ExitCode::kBadInput, {"blade.length_m", "two"}},
        {"[blade]\nlength_m = [0.2, 3.0]\n", ExitCode::kBadInput, {"patch.side_m", "reach"}},
        {"[colour]\ntip = [0.1, 0.2, 1.5]\n", ExitCode::kBadInput, {"colour.tip", "0 to 1"}},
        {"name = \"../up\"\n", ExitCode::kBadInput, {"name", "../up"}},
        {"seed = \n", ExitCode::kBadInput, {"p.toml:1"}},
    };
    for (const Case& c : cases) {
        const auto [code, text] = error_of([&] { (void)parse_preset(c.text, "p.toml"); });
        EXPECT_EQ(code, c.code) << c.text << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        for (const std::string& part : c.says)
            EXPECT_NE(text.find(part), std::string::npos)
                << c.text << "'" << part << "' not in: " << text;
    }
}

// ---- patch

TEST(Patch, RestCurveKeepsLengthAndAngles) {
    for (const double bend : {0.0, 1e-5, 0.3, 1.0, 2.2}) {
        const RestCurve curve = rest_curve(0.3, 0.2, bend, 0.7);
        double length = 0; // by summing chords
        for (int i = 0; i < 4096; ++i)
            length += glm::length(
                glm::dvec3(
                    shared::blade_curve(curve.v1, curve.v2, static_cast<float>(i + 1) / 4096)) -
                glm::dvec3(shared::blade_curve(curve.v1, curve.v2, static_cast<float>(i) / 4096)));
        EXPECT_NEAR(length, 0.3, 2e-5) << bend;
        EXPECT_NEAR(curve_length(curve.v1, curve.v2), 0.3, 1e-6) << bend;
        const shared::vec3 root = shared::blade_tangent(curve.v1, curve.v2, 0),
                           tip = shared::blade_tangent(curve.v1, curve.v2, 1);
        EXPECT_NEAR(std::acos(root.y), 0.2, 1e-4);
        EXPECT_NEAR(std::acos(tip.y), 0.2 + bend, 1e-4);
    }
}

TEST(Patch, VariantsAgreeAlongEdgesAndDifferInside) {
    const Preset preset = small_meadow();
    const Patch patch = small_patch();
    ASSERT_EQ(patch.variants(), 3);
    EXPECT_EQ(patch.variant(0).size(), 1200u);
    const double border = border_width(preset);
    std::size_t same_inside = 0, inside = 0, at_border = 0;
    for (int v = 1; v < patch.variants(); ++v) {
        ASSERT_EQ(patch.variant(v).size(), patch.variant(0).size());
        for (std::size_t i = 0; i < patch.variant(0).size(); ++i) {
            const BladeRecord &a = patch.variant(0)[i], &b = patch.variant(v)[i];
            const bool same = std::memcmp(&a, &b, sizeof a) == 0;
            const auto touches_rim = [&](const BladeRecord& r) {
                const Outline o = outline_of(r);
                return std::min(o.low.x, o.low.z) < 0.02 * patch.side_m ||
                       std::max(o.high.x, o.high.z) > 0.98 * patch.side_m;
            };
            const auto rooted_in_rim = [&](const BladeRecord& r) {
                return std::min({r.root.x, r.root.y, 2 - r.root.x, 2 - r.root.y}) < border * 0.999;
            };
            if (touches_rim(a) || touches_rim(b) || rooted_in_rim(a) || rooted_in_rim(b)) {
                EXPECT_TRUE(same) << "blade " << i << " of variant " << v;
                ++at_border;
            } else {
                ++inside;
                same_inside += same;
            }
        }
    }
    EXPECT_GT(at_border, 500u);
    EXPECT_GT(inside, 500u);
    EXPECT_LT(static_cast<double>(same_inside),
              0.45 * static_cast<double>(inside)); // whole tufts near the rim are shared
}

TEST(Patch, RanksAndSeedsHaveEqualCountsAndAreIndependent) {
    const Patch patch = small_patch();
    for (int v = 0; v < patch.variants(); ++v) {
        const auto blades = patch.variant(v);
        std::vector<int> rank(256), seed(256), joint(64);
        double product = 0;
        float last = 0;
        for (const BladeRecord& b : blades) {
            EXPECT_EQ(b.root.z, shared::unorm8_to_unit(std::floor(b.root.z * 256) / 255.0f));
            ++rank[static_cast<std::size_t>(b.root.z * 256)];
            ++seed[static_cast<std::size_t>(b.root.w * 256)];
            ++joint[static_cast<std::size_t>(b.root.z * 8) * 8 +
                    static_cast<std::size_t>(b.root.w * 8)];
            product += (b.root.z - 0.5) * (b.root.w - 0.5) * 12;
            EXPECT_GE(b.root.z, last);
            last = b.root.z;
        }
        const auto [low, high] = std::ranges::minmax(rank);
        EXPECT_LE(high - low, 1);
        const auto [seed_low, seed_high] = std::ranges::minmax(seed);
        EXPECT_LE(seed_high - seed_low, 1);
        EXPECT_LT(std::abs(product / static_cast<double>(blades.size())), 0.01);
        const double expected = static_cast<double>(blades.size()) / 64;
        for (const int n : joint)
            EXPECT_NEAR(n, expected, 0.3 * expected);
    }
}

/// Mean distance to the nearest other point on the torus.
double spacing(const std::vector<shared::vec2>& points, double side) {
    double sum = 0;
    for (const shared::vec2& p : points) {
        double least = 1e9;
        for (const shared::vec2& q : points)
            if (&p != &q)
                least = std::min(least, std::hypot(nearest_image(p.x - q.x, side),
                                                   nearest_image(p.y - q.y, side)));
        sum += least;
    }
    return sum / static_cast<double>(points.size());
}

TEST(Patch, EveryRankPrefixIsSpreadMoreEvenlyThanChance) {
    const Patch patch = small_patch();
    std::mt19937 random(1);
    for (int v = 0; v < patch.variants(); ++v) {
        std::vector<shared::vec2> all;
        for (const BladeRecord& b : patch.variant(v))
            all.emplace_back(b.root.x, b.root.y);
        for (const double share : {0.05, 0.1, 0.25, 0.5}) {
            const auto count = static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size()));
            const double ranked = spacing({all.begin(), all.begin() + count}, 2);
            std::vector<shared::vec2> shuffled = all;
            double chance = 0;
            for (int trial = 0; trial < 4; ++trial) {
                std::ranges::shuffle(shuffled, random);
                chance += spacing({shuffled.begin(), shuffled.begin() + count}, 2) / 4;
            }
            EXPECT_GT(ranked, 1.25 * chance) << "variant " << v << ", share " << share;
        }
    }
}

TEST(Patch, IsTheSameAtAnyThreadCount) {
    const Patch one = generate_patch(small_meadow(), 1), four = generate_patch(small_meadow(), 4);
    ASSERT_EQ(one.blades.size(), four.blades.size());
    EXPECT_EQ(
        std::memcmp(one.blades.data(), four.blades.data(), one.blades.size() * sizeof(BladeRecord)),
        0);
}

// ---- layers and slices

/// Share of rays across a slab that meet a blade inside it: the exact coverage of the slab's
/// projection.
double slab_coverage(const BladeField& field, Family family, double low, double high, int rays) {
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        const auto n = static_cast<std::uint64_t>(i);
        const double a = base::hash_unit(3, 1, n) * field.side(), b = base::hash_unit(3, 2, n);
        std::optional<RayHit> hit;
        if (family == Family::kLayer)
            hit = field.cast({a, high, b * field.side()}, {0, -1, 0}, high - low);
        else if (family == Family::kSliceX)
            hit = field.cast({low, b * field.canopy(), a}, {1, 0, 0}, high - low);
        else
            hit = field.cast({a, b * field.canopy(), low}, {0, 0, 1}, high - low);
        hits += hit.has_value();
    }
    return static_cast<double>(hits) / rays;
}

TEST(Raster, CoverageOfEverySlabAgreesWithRays) {
    constexpr int kRays = 12000;
    const grass::GrassSet& set = small_set();
    const BladeField field(std::span(set.blades).subspan(0, set.variant_begin[1]), set.side_m,
                           set.canopy_m);
    double total_error = 0;
    int slabs = 0;
    for (const grass::FarLevel& level : set.levels) {
        const auto check = [&](Family family, const grass::TextureArray& array, int image,
                               double low, double high) {
            const double truth = slab_coverage(field, family, low, high, kRays);
            const double shown = mean_coverage(array, image, 0);
            const double noise = std::sqrt(truth * (1 - truth) / kRays);
            EXPECT_NEAR(shown, truth, 4 * noise + 0.003)
                << static_cast<int>(family) << " at " << low;
            total_error += shown - truth;
            ++slabs;
        };
        for (int i = 0; i < level.layer_count; ++i)
            check(Family::kLayer, level.layers, shared::layer_index(0, i, level.layer_count, 0),
                  static_cast<double>(set.canopy_m) * i / level.layer_count,
                  static_cast<double>(set.canopy_m) * (i + 1) / level.layer_count);
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < level.slice_count; ++i)
                check(axis == shared::kAxisX ? Family::kSliceX : Family::kSliceZ, level.slices,
                      shared::slice_index(0, axis, i, level.slice_count, 0),
                      static_cast<double>(set.side_m) * i / level.slice_count,
                      static_cast<double>(set.side_m) * (i + 1) / level.slice_count);
    }
    EXPECT_LT(std::abs(total_error / slabs), 0.002); // no bias: nothing is dilated
}

TEST(Raster, ATexelNamesABladeThatStandsWhereItSays) {
    const grass::GrassSet& set = small_set();
    const grass::FarLevel& level = set.levels[0];
    const int size = level.layers.width;
    const double texel = static_cast<double>(set.side_m) / size,
                 step = 2.0 * set.offset_range_m / 255;
    int checked = 0;
    const auto check = [&](int variant, const std::uint8_t* id, const std::uint8_t* shape,
                           glm::dvec3 at) {
        if (id[0] == 0) {
            EXPECT_EQ(id[1] | id[2] | id[3] | shape[0] | shape[1] | shape[2] | shape[3], 0);
            return;
        }
        const shared::vec2 offset =
            shared::decode_offset(shared::vec2(shape[2], shape[3]) / 255.0f, set.offset_range_m);
        bool found = false;
        for (std::uint32_t b = set.variant_begin[variant];
             b < set.variant_begin[variant + 1] && !found; ++b) {
            const BladeRecord& blade = set.blades[b];
            found = static_cast<int>(blade.root.z * 256) == id[1] &&
                    static_cast<int>(blade.root.w * 256) == id[2] &&
                    std::abs(nearest_image(blade.root.x - at.x - offset.x, set.side_m)) < step &&
                    std::abs(nearest_image(blade.root.y - at.z - offset.y, set.side_m)) < step;
            if (!found)
                continue;
            shared::vec3 t = shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2),
                                                   id[3] / 255.0f);
            const shared::vec3 decoded =
                shared::decode_tangent(shared::vec2(shape[0], shape[1]) / 255.0f);
            EXPECT_GT(glm::dot(decoded, t.y < 0 ? -t : t), 0.98f);
            // The named point of the blade lies within the texel, give or take the blade's width
            // and the coding.
            const shared::vec3 p =
                shared::blade_curve(shared::vec3(blade.v1), shared::vec3(blade.v2), id[3] / 255.0f);
            if (at.y > 0) { // slice: compare heights
                EXPECT_NEAR(p.y, at.y, texel * 1.5 + 0.004);
            }
        }
        EXPECT_TRUE(found);
        ++checked;
    };
    for (std::uint64_t n = 0; n < 20000; ++n) {
        const int variant = static_cast<int>(n % 3);
        const auto x = static_cast<int>(base::hash64(1, 1, n) % static_cast<std::uint64_t>(size));
        const auto z = static_cast<int>(base::hash64(1, 2, n) % static_cast<std::uint64_t>(size));
        const int i =
            static_cast<int>(base::hash64(1, 3, n) % static_cast<std::uint64_t>(level.layer_count));
        const auto texel_at = [&](const grass::TextureArray& a, int image, int u, int v) {
            return a.mips[0].data() +
                   4 * ((static_cast<std::size_t>(image) * static_cast<std::size_t>(a.height) +
                         static_cast<std::size_t>(v)) *
                            static_cast<std::size_t>(size) +
                        static_cast<std::size_t>(u));
        };
        check(variant,
              texel_at(level.layers, shared::layer_index(variant, i, level.layer_count, 0), x, z),
              texel_at(level.layers, shared::layer_index(variant, i, level.layer_count, 1), x, z),
              {(x + 0.5) * texel, 0, (z + 0.5) * texel});
        const int row = z % level.slices.height;
        const double y = (row + 0.5) * set.canopy_m / level.slices.height,
                     middle = (i + 0.5) * set.side_m / level.slice_count;
        check(
            variant,
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisX, i, level.slice_count, 0), x, row),
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisX, i, level.slice_count, 1), x, row),
            {middle, y, (x + 0.5) * texel});
        check(
            variant,
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisZ, i, level.slice_count, 0), x, row),
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisZ, i, level.slice_count, 1), x, row),
            {(x + 0.5) * texel, y, middle});
    }
    EXPECT_GT(checked, 1000);
}

TEST(Raster, MipsKeepTheMeanCoverage) {
    for (const grass::FarLevel& level : small_set().levels)
        for (const grass::TextureArray* array : {&level.layers, &level.slices})
            for (std::size_t m = 1; m < array->mips.size() && (array->width >> m) >= 8; ++m) {
                double base = 0, mip = 0; // over all images: a nearly empty one has too few steps
                                          // of 1/255 to judge
                for (int image = 0; image < array->layers; image += shared::kPlanes) {
                    base += mean_coverage(*array, image, 0);
                    mip += mean_coverage(*array, image, m);
                }
                EXPECT_NEAR(mip / base, 1.0, 0.02) << array->width << " mip " << m;
            }
}

/// Mean coverage step across the joint of two variants, over all layers, as a multiple of the
/// interior's median step.
double joint_gradient(const grass::GrassSet& set, int left, int right, bool along_z, int slip) {
    const grass::FarLevel& level = set.levels[0];
    const int size = level.layers.width;
    const auto coverage = [&](int variant, int layer, int u, int v) {
        const int x = along_z ? v : u, z = along_z ? u : v;
        return static_cast<int>(
            level.layers.mips[0][4 * ((static_cast<std::size_t>(shared::layer_index(
                                           variant, layer, level.layer_count, 0)) *
                                           static_cast<std::size_t>(size) +
                                       static_cast<std::size_t>(z)) *
                                          static_cast<std::size_t>(size) +
                                      static_cast<std::size_t>(x))]);
    };
    std::vector<double> steps(static_cast<std::size_t>(size));
    for (int layer = 0; layer < level.layer_count; ++layer)
        for (int v = 0; v < size; ++v) {
            for (int u = 0; u + 1 < size; ++u)
                steps[static_cast<std::size_t>(u)] +=
                    std::abs(coverage(left, layer, u, v) - coverage(left, layer, u + 1, v));
            steps.back() += std::abs(coverage(left, layer, size - 1, v) -
                                     coverage(right, layer, 0, (v + slip) % size));
        }
    const double joint = steps.back();
    steps.pop_back();
    std::ranges::nth_element(steps, steps.begin() + size / 2);
    return joint / steps[static_cast<std::size_t>(size / 2)];
}

TEST(Raster, JointsOfAnyVariantsAreNoRougherThanTheInterior) {
    base::set_verbosity(base::Verbosity::kQuiet);
    Preset preset =
        small_meadow(); // dense, so that a single column of texels holds enough blades to judge
    preset.density_per_m2 = 2500;
    preset.variants = 2;
    preset.levels = 1;
    const grass::GrassSet set = bake_set(preset, {.threads = 2});
    double slipped = 0;
    for (int a = 0; a < set.variants; ++a)
        for (int b = 0; b < set.variants; ++b)
            for (const bool along_z : {false, true}) {
                EXPECT_LT(joint_gradient(set, a, b, along_z, 0), 1.2) << a << b << along_z;
                slipped +=
                    joint_gradient(set, a, b, along_z, 37) / (2 * set.variants * set.variants);
            }
    EXPECT_GT(slipped, 1.2); // the measure does see a seam
}

TEST(FlatRays, TheThreeFamiliesCoverWhatTheBladesCover) {
    base::set_verbosity(base::Verbosity::kQuiet);
    Preset preset = load_preset(fs::path(SWARD_SOURCE_DIR) / "texgen/presets/meadow.toml");
    preset.variants = 1;
    preset.levels = 2;
    const grass::GrassSet set = bake_set(preset, {.threads = 2});
    std::printf("elevation  rays   level 0  level 1  shells  slices\n");
    for (const grass::FarRow& row : set.far) {
        const auto flat = [&](int level, FlatUse use) {
            return flat_coverage(set, level, row.elevation_deg, use, 8000);
        };
        const grass::FarRow all = flat(0, {});
        std::printf("%9.0f  %.3f  %.3f    %.3f    %.3f   %.3f\n", row.elevation_deg, row.coverage,
                    all.coverage, flat(1, {}).coverage, flat(0, {1, 0}).coverage,
                    flat(0, {0, 1}).coverage);
        // Uncalibrated, shells and slices together show up to 9 points too much between nadir and
        // grazing; either end, where one family carries the picture, is exact.
        const bool end = row.elevation_deg > 85 || row.elevation_deg < 12;
        EXPECT_NEAR(all.coverage, row.coverage, end ? 0.02 : 0.11) << row.elevation_deg;
        EXPECT_NEAR(all.height, row.height, 0.05) << row.elevation_deg;
        // Shells thinned by 1 - 1.9 |d_horizontal|, at least 0.2, bring every elevation in.
        const double horizontal = std::cos(row.elevation_deg * 3.14159265 / 180);
        const FlatUse thinned{std::clamp(1 - 1.9 * horizontal, 0.2, 1.0), 1};
        EXPECT_NEAR(flat(0, thinned).coverage, row.coverage, 0.03) << row.elevation_deg;
    }
}

// ---- files

grass::TextureArray noise_array(int width, int height, int layers) {
    grass::TextureArray array{width, height, layers, {}};
    for (int m = 0; m < 3; ++m) {
        array.mips.emplace_back(grass::mip_bytes(array, m));
        for (std::size_t i = 0; i < array.mips.back().size(); ++i)
            array.mips.back()[i] =
                static_cast<std::uint8_t>(base::hash64(8, static_cast<std::uint64_t>(m), i) % 7);
    }
    return array;
}

TEST(Ktx2, RoundTripKeepsEveryByte) {
    const grass::TextureArray array = noise_array(40, 12, 6);
    const std::vector<std::byte> bytes = grass::encode_ktx2(array, 3);
    const grass::TextureArray back = grass::decode_ktx2(bytes, "a.ktx2");
    EXPECT_EQ(back.width, 40);
    EXPECT_EQ(back.height, 12);
    EXPECT_EQ(back.layers, 6);
    EXPECT_EQ(back.mips, array.mips);
}

TEST(Ktx2, RefusesCutFlippedAndForeignBytes) {
    const std::vector<std::byte> bytes = grass::encode_ktx2(noise_array(40, 12, 6), 3);
    for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 1 : 97)
        EXPECT_EQ(error_of([&] {
                      (void)grass::decode_ktx2(std::span(bytes).first(size), "cut.ktx2");
                  }).first,
                  ExitCode::kBadInput)
            << size;
    const grass::TextureArray whole = grass::decode_ktx2(bytes, "whole.ktx2");
    std::size_t harmless = 0; // free text, padding, bits that zstd does not read
    for (std::size_t at = 0; at < bytes.size(); at += at < 400 ? 1 : 53) {
        std::vector<std::byte> bad = bytes;
        bad[at] ^= std::byte{0x10};
        const auto [code, text] = error_of(
            [&] { EXPECT_EQ(grass::decode_ktx2(bad, "flip.ktx2").mips, whole.mips) << at; });
        harmless += code == ExitCode::kDone;
        EXPECT_TRUE(code == ExitCode::kDone || code == ExitCode::kBadInput ||
                    code == ExitCode::kOverLimit)
            << at << text;
    }
    EXPECT_LT(harmless, 45u);
    std::vector<std::byte> huge = bytes; // 65,536 images: refused before memory is taken
    huge[34] = std::byte{1};
    EXPECT_EQ(error_of([&] { (void)grass::decode_ktx2(huge, "huge.ktx2"); }).first,
              ExitCode::kOverLimit);
}

TEST(BladesGlb, RoundTripIsExact) {
    const Patch patch = small_patch();
    const std::vector<std::byte> bytes = grass::encode_blades(patch.blades, patch.variant_begin, 2);
    const grass::BladeList back = grass::decode_blades(bytes, "blades.glb", 2);
    EXPECT_EQ(back.variant_begin, patch.variant_begin);
    ASSERT_EQ(back.blades.size(), patch.blades.size());
    EXPECT_EQ(std::memcmp(back.blades.data(), patch.blades.data(),
                          back.blades.size() * sizeof(BladeRecord)),
              0);
}

TEST(BladesGlb, RefusesCutDeepAndOutsideValues) {
    Patch patch = small_patch();
    const std::vector<std::byte> bytes = grass::encode_blades(patch.blades, patch.variant_begin, 2);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{19}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1})
        EXPECT_EQ(error_of([&] {
                      (void)grass::decode_blades(std::span(bytes).first(size), "cut.glb", 2);
                  }).first,
                  ExitCode::kBadInput);
    std::vector<std::byte> deep = bytes;
    std::fill(deep.begin() + 20, deep.begin() + 2000, std::byte{'['});
    EXPECT_EQ(error_of([&] { (void)grass::decode_blades(deep, "deep.glb", 2); }).first,
              ExitCode::kBadInput);
    EXPECT_EQ(error_of([&] { (void)grass::decode_blades(bytes, "side.glb", 1); }).first,
              ExitCode::kBadInput); // roots beyond 1 m
    patch.blades[7].v2.x = std::nanf("");
    const auto bad = grass::encode_blades(patch.blades, patch.variant_begin, 2);
    EXPECT_EQ(error_of([&] { (void)grass::decode_blades(bad, "nan.glb", 2); }).first,
              ExitCode::kBadInput);
}

TEST(Volume, HoldsTheBladesArea) {
    const grass::GrassSet& set = small_set();
    const VolumeInfo info = inspect_volume(encode_volume(set));
    EXPECT_EQ(info.grids, (std::vector<std::string>{"density", "tangent", "rank", "seed"}));
    EXPECT_NEAR(info.voxel_m, 2.0 / 256, 1e-9);
    double area = 0;
    for (std::uint32_t b = 0; b < set.variant_begin[1];
         ++b) // the outline 1 - v^2 keeps two thirds of the width
        area += set.blades[b].shape.y * set.blades[b].v1.w * 2 * 2 / 3;
    EXPECT_NEAR(info.density_sum * info.voxel_m * info.voxel_m, area,
                0.05 * area); // some voxels are full
    EXPECT_GT(info.active_voxels, 10000u);
}

std::map<std::string, std::string> hashes(const fs::path& directory) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(directory))
        all[entry.path().filename().string()] =
            base::sha256_hex(base::read_file(entry.path(), 1 << 30));
    return all;
}

TEST(GrassSet, SameSeedSameBytesAtAnyThreadCountAndReadsBackEqual) {
    base::set_verbosity(base::Verbosity::kQuiet);
    const Folder folder;
    Preset preset = small_meadow();
    preset.size = 128;
    for (const int threads : {1, 2}) {
        const BakeOptions options{.threads = threads};
        write_set(bake_set(preset, options), preset, folder.path() / std::to_string(threads),
                  options);
    }
    const auto one = hashes(folder.path() / "1");
    EXPECT_EQ(one, hashes(folder.path() / "2"));
    for (const char* name : {"set.json", "blades.glb", "volume.vdb", "preview.png", "layers.ktx2",
                             "layers_1.ktx2", "slices_2.ktx2"})
        EXPECT_TRUE(one.contains(name)) << name;
    preset.seed = 2;
    const grass::GrassSet made = bake_set(preset, {});
    write_set(made, preset, folder.path() / "2", {}); // an earlier set is replaced
    EXPECT_NE(one, hashes(folder.path() / "2"));
    const grass::GrassSet read = grass::read_grass_set(folder.path() / "2");
    EXPECT_EQ(read.name, made.name);
    EXPECT_EQ(read.seed, 2u);
    EXPECT_EQ(read.canopy_m, made.canopy_m);
    EXPECT_EQ(read.offset_range_m, made.offset_range_m);
    EXPECT_EQ(std::memcmp(&read.appearance, &made.appearance, sizeof made.appearance), 0);
    ASSERT_EQ(read.levels.size(), made.levels.size());
    for (std::size_t k = 0; k < read.levels.size(); ++k) {
        EXPECT_EQ(read.levels[k].layers.mips, made.levels[k].layers.mips);
        EXPECT_EQ(read.levels[k].slices.mips, made.levels[k].slices.mips);
    }
    ASSERT_EQ(read.far.size(), made.far.size());
    EXPECT_EQ(read.far[3].coverage, made.far[3].coverage);
    EXPECT_EQ(std::memcmp(read.blades.data(), made.blades.data(),
                          made.blades.size() * sizeof(BladeRecord)),
              0);
}

TEST(GrassSet, RefusesDamageBeforeParsingAndSparesOtherDirectories) {
    base::set_verbosity(base::Verbosity::kQuiet);
    const Folder folder;
    Preset preset = small_meadow();
    preset.size = 64;
    preset.density_per_m2 = 50;
    const BakeOptions options{.volume = false, .preview = false};
    const fs::path set = folder.path() / "set";
    write_set(bake_set(preset, options), preset, set, options);
    EXPECT_NO_THROW((void)grass::read_grass_set(set));
    EXPECT_EQ(error_of([&] { (void)grass::read_grass_set(folder.path() / "none"); }).first,
              ExitCode::kIo);
    for (const char* name : {"blades.glb", "layers.ktx2", "slices_1.ktx2"}) {
        const std::vector<std::byte> good = base::read_file(set / name, 1 << 30);
        std::vector<std::byte> bad = good;
        bad[bad.size() / 2] ^= std::byte{1};
        base::write_file_atomic(set / name, bad);
        const auto [code, text] = error_of([&] { (void)grass::read_grass_set(set); });
        EXPECT_EQ(code, ExitCode::kBadInput);
        EXPECT_NE(text.find(name), std::string::npos) << text;
        EXPECT_NE(text.find("SHA-256"), std::string::npos) << text;
        fs::remove(set / name);
        EXPECT_EQ(error_of([&] { (void)grass::read_grass_set(set); }).first, ExitCode::kIo);
        base::write_file_atomic(set / name, good);
    }
    std::string json = base::read_text(set / grass::kSetJson, 1 << 20);
    const std::string newer =
        std::string(json).replace(json.find("\"version\": 1"), 12, "\"version\": 9");
    for (const std::string& text : {newer, json.substr(0, json.size() / 2), std::string(5000, '['),
                                    std::string("{}"), std::string()}) {
        base::write_file_atomic(set / grass::kSetJson, text);
        EXPECT_EQ(error_of([&] { (void)grass::read_grass_set(set); }).first, ExitCode::kBadInput)
            << text.substr(0, 40);
    }
    base::write_file_atomic(folder.path() / "mine.txt", std::string("keep"));
    EXPECT_EQ(error_of([&] { require_set_place(folder.path()); }).first, ExitCode::kIo);
    EXPECT_TRUE(fs::exists(folder.path() / "mine.txt"));
}

} // namespace
} // namespace sward::texgen
