// SPDX-License-Identifier: Apache-2.0
// volume.vdb: the area it holds, what is read back, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "base/file.h"
#include "grass/set_files.h"
#include "grass_fixture.h"
#include "shared/shading.h"
#include "texgen/patch/canopy.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_writer.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

double area_of_blades(const grass::GrassSet& set) {
    double area = 0;
    for (std::uint32_t b = 0; b < set.variant_begin[1]; ++b)
        area += blade_area(set, set.blades[b]);
    return area;
}

double area_of(const Volume& volume) {
    double sum = 0;
    for (const float density : volume.density)
        sum += density;
    return sum * volume.voxel_m * volume.voxel_m;
}

/// Half floats keep eleven bits.
void expect_half(float read, float written) {
    EXPECT_LE(std::abs(read - written), std::abs(written) / 2048 + 1e-7f);
}

TEST(Volume, HoldsTheBladesArea) {
    const grass::GrassSet& set = small_set();
    const Volume volume = rasterise_volume(set);
    const double area = area_of_blades(set);
    EXPECT_NEAR(area_of(volume), area, 0.01 * area);
    // A straight upright blade that faces x has the area of its outline.
    grass::GrassSet one = set;
    one.blades = {set.blades.front()};
    one.variant_begin = {0, 1};
    one.blades[0].v1 = {0, 0.1f, 0, 0.003f};
    one.blades[0].v2 = {0, 0.2f, 0, 0.5f};
    one.blades[0].shape.x = 0;
    EXPECT_NEAR(blade_area(one, one.blades[0]), 0.2 * 0.006 * 2 / 3, 1e-8);
    EXPECT_NEAR(area_of(rasterise_volume(one)), 0.2 * 0.006 * 2 / 3, 1e-5);
}

TEST(Volume, BladesOverTheEdgeComeBackOnTheOtherSide) {
    grass::GrassSet one = small_set();
    one.blades = {one.blades.front()};
    one.variant_begin = {0, 1};
    one.blades[0].root.x = 0.001f;
    one.blades[0].root.y = 1;
    one.blades[0].v1 = {-0.05f, 0.1f, 0, 0.003f};
    one.blades[0].v2 = {-0.15f, 0.15f, 0, 0.5f};
    const Volume volume = rasterise_volume(one);
    int far_side = 0;
    for (const VoxelPlace& at : volume.at)
        far_side += at.x > 200;
    EXPECT_GT(far_side, static_cast<int>(volume.at.size() / 2));
    EXPECT_NEAR(area_of(volume), blade_area(one, one.blades[0]),
                0.01 * blade_area(one, one.blades[0]));
}

TEST(Volume, CompanionsAreTheBladesOwn) {
    const grass::GrassSet& set = small_set();
    const Volume volume = rasterise_volume(set);
    ASSERT_EQ(volume.at.size(), volume.colour.size());
    ASSERT_GT(volume.at.size(), 10000u);
    for (std::size_t i = 0; i < volume.at.size(); i += 97) {
        const auto same = [&](const shared::BladeRecord& b) {
            return b.root.z == volume.rank[i] && b.root.w == volume.seed[i];
        };
        const auto end = set.blades.begin() + set.variant_begin[1];
        const auto blade = std::find_if(set.blades.begin(), end, same);
        ASSERT_NE(blade, end);
        EXPECT_NEAR(glm::length(volume.tangent[i]), 1, 1e-5f);
        // The colour is one that the shading function gives some place along this blade.
        float nearest = 1;
        for (int k = 0; k <= 400; ++k)
            nearest = std::min(nearest,
                               glm::distance(volume.colour[i],
                                             shared::blade_albedo(set.species[0].look,
                                                                  {volume.rank[i], volume.seed[i]},
                                                                  static_cast<float>(k) / 400, 1)));
        EXPECT_LT(nearest, 2e-3f);
    }
}

TEST(Volume, ReadsBackEqualGridByGrid) {
    const grass::GrassSet& set = small_set();
    const std::vector<std::byte> bytes = encode_volume(set);
    const VdbFile file(bytes, "volume.vdb");
    std::vector<std::string> names;
    for (const VdbGridInfo& grid : file.grids())
        names.push_back(grid.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"density", "tangent", "colour", "rank", "seed", "others"}));
    const Volume made = rasterise_volume(set), read = file.read_volume({});
    EXPECT_EQ(read.voxel_m, made.voxel_m);
    EXPECT_EQ(read.cells, made.cells);
    EXPECT_EQ(read.period_m, made.period_m);
    EXPECT_EQ(read.preset, "small");
    EXPECT_EQ(read.set_seed, set.seed);
    EXPECT_EQ(read.format_version, grass::kSetFormatVersion);
    ASSERT_TRUE(read.at == made.at);
    EXPECT_EQ(read.rank, made.rank); // (n + 0.5) / 256 is exact in half
    EXPECT_EQ(read.seed, made.seed);
    int shared = 0;
    for (std::size_t i = 0; i < read.at.size(); ++i) {
        expect_half(read.density[i], made.density[i]);
        expect_half(read.others[i], made.others[i]);
        ASSERT_LT(made.others[i], made.density[i]) << "the companions' blade has a part";
        shared += made.others[i] > 0;
        for (int c = 0; c < 3; ++c) {
            expect_half(read.colour[i][c], made.colour[i][c]);
            ASSERT_NEAR(read.tangent[i][c], made.tangent[i][c], 2e-3f);
        }
    }
    EXPECT_GT(shared, 0);
    // What has been rounded once stays as it is.
    Volume again = read;
    const std::vector<std::byte> second = encode_vdb(again);
    const Volume twice = VdbFile(second, "volume.vdb").read_volume({});
    EXPECT_EQ(twice.density, read.density);
    EXPECT_EQ(twice.colour, read.colour);
    EXPECT_EQ(encode_vdb(read), second) << "equal grids, equal bytes";
}

class VolumeFiles : public ::testing::Test {
protected:
    VolumeFiles()
        : folder_(fs::temp_directory_path() / fmt::format("sward-volume-test-{}", ::getpid())) {
        fs::create_directories(folder_);
    }
    ~VolumeFiles() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(VolumeFiles, OurHashRefusesDamageBeforeOpenVdb) {
    base::set_verbosity(base::Verbosity::kQuiet);
    Preset preset = small_meadow();
    preset.size = 64;
    preset.density_per_m2 = 50;
    const fs::path set = folder_ / "set";
    const BakeOptions options{.preview = false};
    write_set(bake_set(preset, options), preset, set, options);
    EXPECT_GT(read_volume(set).at.size(), 100u);
    const fs::path file = set / grass::kVolumeFile;
    const std::vector<std::byte> good = base::read_file(file, 1 << 30);
    for (const std::size_t at : {std::size_t{0}, good.size() / 3, good.size() - 1}) {
        std::vector<std::byte> flipped = good;
        flipped[at] ^= std::byte{1};
        base::write_file_atomic(file, flipped);
        const auto [code, text] = error_of([&] { (void)read_volume(set); });
        EXPECT_EQ(code, ExitCode::kBadInput);
        EXPECT_NE(text.find("SHA-256"), std::string::npos) << text;
    }
    base::write_file_atomic(file, std::span(good).subspan(0, good.size() / 2));
    const auto [code, text] = error_of([&] { (void)read_volume(set); });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("size"), std::string::npos) << text;
    fs::remove(file);
    EXPECT_EQ(error_of([&] { (void)read_volume(set); }).first, ExitCode::kIo);
}

TEST(VdbFile, RefusesWhatIsCutOffOrNoVolume) {
    Volume volume;
    volume.voxel_m = 0.01;
    volume.cells = {20, 5, 20};
    for (std::uint16_t y = 0; y < 5; ++y)
        for (std::uint16_t z = 0; z < 20; ++z)
            for (std::uint16_t x = 0; x < 20; ++x) {
                volume.at.push_back({x, y, z});
                volume.density.push_back(0.25f + 0.03125f * static_cast<float>(x % 7));
            }
    const std::vector<std::byte> good = encode_vdb(volume);
    EXPECT_EQ(VdbFile(good, "a.vdb").read_volume({}).density, volume.density);
    for (std::size_t n = 0; n < good.size(); n += 1 + good.size() / 200) {
        const auto [code, text] = error_of(
            [&] { (void)VdbFile(std::span(good).subspan(0, n), "cut.vdb").read_volume({}); });
        EXPECT_EQ(code, ExitCode::kBadInput) << n;
        EXPECT_EQ(text.find("cut.vdb: "), 0u) << text;
        EXPECT_NE(text.find("expected"), std::string::npos) << text;
    }
    volume.density[7] = -1;
    EXPECT_EQ(error_of([&] { (void)VdbFile(encode_vdb(volume), "neg.vdb").read_volume({}); }).first,
              ExitCode::kBadInput);
    volume.density[7] = NAN;
    const auto [code, text] = error_of([&] {
        const std::vector<std::byte> bytes = encode_vdb(volume);
        (void)VdbFile(bytes, "nan.vdb").read_volume({});
    });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("voxel (7, 0, 0)"), std::string::npos) << text;
}

TEST(Volume, CarriesTheMeanLightOfItsSpecies) {
    grass::GrassSet set = small_set();
    grass::Species other = set.species.front();
    set.species.front().look.gloss = {1, 2, 0.25f, 8};
    other.look.gloss = {3, 4, 0.75f, 24};
    set.species.front().look.translucency = 0;
    other.look.translucency = 1;
    set.species = {set.species.front(), other};
    set.blades.resize(2);
    set.variant_begin = {0, 2};
    set.blades[1] = set.blades[0]; // the same blade once of each
    set.blades[1].shape.w = set.blades[0].shape.w + 1;
    ASSERT_EQ(species_of(set.blades[1]), species_of(set.blades[0]) + 1);
    const std::vector<std::byte> bytes = encode_volume(set);
    const Species light = VdbFile(bytes, "l.vdb").read_volume({}).light;
    EXPECT_NEAR(light.kd, 2, 1e-5);
    EXPECT_NEAR(light.pd, 3, 1e-5);
    EXPECT_NEAR(light.ks, 0.5, 1e-5);
    EXPECT_NEAR(light.ps, 16, 1e-4);
    EXPECT_NEAR(light.translucency, 0.5, 1e-5);
}

TEST(VdbFile, ZUpIsTurnedAndScaled) {
    Volume volume;
    volume.voxel_m = 1;
    volume.at = {{0, 0, 0}, {4, 0, 0}, {0, 1, 2}}; // as x, y, z of the file
    volume.density = {1, 1, 0.5f};
    volume.tangent = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}};
    const std::vector<std::byte> bytes = encode_vdb(volume);
    const Volume read = VdbFile(bytes, "z.vdb").read_volume({.z_up = true, .scale = 0.01});
    EXPECT_NEAR(read.voxel_m, 0.01, 1e-9);
    EXPECT_EQ(read.cells, glm::ivec3(5, 3, 2));
    ASSERT_EQ(read.at.size(), 3u);
    EXPECT_TRUE(read.at[2] == (VoxelPlace{0, 2, 0})); // the file's z is our height, its y our -z
    EXPECT_EQ(read.density[2], 0.5f);
    EXPECT_EQ(read.tangent[0], glm::vec3(0, 1, 0));
    EXPECT_EQ(read.tangent[2], glm::vec3(0, 0, -1));
}

} // namespace
} // namespace sward::texgen
