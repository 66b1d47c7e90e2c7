// SPDX-License-Identifier: Apache-2.0
// Volumes from elsewhere as far-only sets.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "base/file.h"
#include "grass/set_files.h"
#include "grass_fixture.h"
#include "shared/shading.h"
#include "texgen/far/far_table.h"
#include "texgen/far/flat_rays.h"
#include "texgen/import/import.h"
#include "texgen/import/import_field.h"
#include "texgen/patch/canopy.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_writer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr int kRays = 16384; // 0.4 points

ImportQuery small_query() {
    return {
        .name = "imported", .layers = 8, .slices = 8, .levels = 3, .far_rays = kRays, .threads = 2};
}

/// volume.vdb of the small set, through the file and back.
const Volume& own_volume() {
    static const Volume volume = [] {
        const std::vector<std::byte> bytes = encode_volume(small_set());
        return VdbFile(bytes, "volume.vdb").read_volume({});
    }();
    return volume;
}

const grass::GrassSet& own_import() {
    static const grass::GrassSet set = import_volume(own_volume(), small_query(), "volume.vdb");
    return set;
}

/// The first variant alone: what volume.vdb holds.
grass::GrassSet first_variant(const grass::GrassSet& set) {
    Patch patch;
    patch.side_m = set.side_m;
    patch.blades.assign(set.blades.begin(), set.blades.begin() + set.variant_begin[1]);
    patch.variant_begin = {0, set.variant_begin[1]};
    for (const grass::Species& species : set.species)
        patch.looks.push_back(species.look);
    grass::GrassSet out;
    out.far = far_table(blade_canopy(patch, set.canopy_m), kRays, 2).rows;
    return out;
}

TEST(Import, OwnVolumeCoversWhatItsBladesDo) {
    const grass::GrassSet& set = own_import();
    const std::vector<grass::FarRow> blades = first_variant(small_set()).far;
    ASSERT_EQ(set.far.size(), blades.size());
    for (std::size_t i = 0; i < blades.size(); ++i) {
        const grass::FarRow& row = set.far[i];
        EXPECT_NEAR(row.coverage, blades[i].coverage, 0.03)
            << blades[i].elevation_deg << " degrees, rays";
        EXPECT_NEAR(row.height * set.canopy_m, blades[i].height * small_set().canopy_m, 0.015)
            << blades[i].elevation_deg << " degrees";
        if (row.elevation_deg < 5)
            continue;
        const double flat =
            flat_coverage(set, 0, row.elevation_deg, {row.shell_share, row.slice_share}, kRays)
                .coverage;
        EXPECT_NEAR(flat, blades[i].coverage, 0.03)
            << blades[i].elevation_deg << " degrees, textures";
        std::printf("%5.1f: blades %.3f, voxels %.3f, textures %.3f\n", row.elevation_deg,
                    blades[i].coverage, row.coverage, flat);
    }
}

TEST(Import, OwnVolumeKeepsColoursRanksAndRoots) {
    const grass::GrassSet& set = own_import();
    EXPECT_TRUE(set.blades.empty());
    EXPECT_EQ(set.variants, 1);
    EXPECT_EQ(set.side_m, small_set().side_m);
    EXPECT_NEAR(set.canopy_m, small_set().canopy_m, own_volume().voxel_m);
    for (const float v : {0.2f, 0.8f}) {
        glm::vec3 mean(0), found(0);
        for (int n = 0; n < 256; ++n) {
            const glm::vec2 id((static_cast<float>(n) + 0.5f) / 256,
                               (static_cast<float>(n * 37 % 256) + 0.5f) / 256);
            mean += shared::blade_albedo(small_set().species[0].look, id, v, 0) / 256.0f;
            for (const grass::Species& species : set.species) // dry blades are one of their own
                found += species.share * shared::blade_albedo(species.look, id, v, 0) / 256.0f;
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], mean[c], 0.15f * mean[c]) << v;
    }
    // Every texel of the lowest layer names a blade that the set knows, and points at its root.
    const grass::FarLevel& level = set.levels[0];
    const int index = shared::layer_index(0, 0, level.layer_count, shared::kPlaneId);
    const std::size_t texels = static_cast<std::size_t>(level.layers.width) *
                               static_cast<std::size_t>(level.layers.height);
    const std::uint8_t* id =
        level.layers.mips[0].data() + 4 * texels * static_cast<std::size_t>(index);
    const std::uint8_t* shape = id + 4 * texels;
    int covered = 0, right = 0;
    for (std::size_t t = 0; t < texels; ++t) {
        if (id[4 * t] == 0)
            continue;
        ++covered;
        const double texel = static_cast<double>(set.side_m) / level.layers.width;
        const glm::vec2 offset = shared::decode_offset(
            glm::vec2(shape[4 * t + 2], shape[4 * t + 3]) / 255.0f, set.offset_range_m);
        const double x =
            (static_cast<double>(t % static_cast<std::size_t>(level.layers.width)) + 0.5) * texel +
            offset.x;
        const double z =
            (static_cast<double>(t / static_cast<std::size_t>(level.layers.width)) + 0.5) * texel +
            offset.y;
        for (std::uint32_t b = 0; b < small_set().variant_begin[1]; ++b) {
            const shared::BladeRecord& blade = small_set().blades[b];
            const auto apart = [&](double a, double c) {
                return std::abs(nearest_image(a - c, set.side_m));
            };
            if (static_cast<int>(blade.root.z * 256) == id[4 * t + 1] &&
                static_cast<int>(blade.root.w * 256) == id[4 * t + 2] &&
                apart(blade.root.x, x) < 0.02 && apart(blade.root.y, z) < 0.02) {
                ++right;
                break;
            }
        }
    }
    EXPECT_GT(covered, 500);
    EXPECT_GT(right, 0.98 * covered);
}

TEST(Import, TheSameBytesAtAnyThreadCount) {
    ImportQuery query = small_query();
    query.levels = 2;
    query.far_rays = 1024;
    query.threads = 1;
    const grass::GrassSet one = import_volume(own_volume(), query, "v.vdb");
    query.threads = 3;
    const grass::GrassSet three = import_volume(own_volume(), query, "v.vdb");
    EXPECT_EQ(one.levels[0].layers.mips, three.levels[0].layers.mips);
    EXPECT_EQ(one.levels[1].slices.mips, three.levels[1].slices.mips);
    for (std::size_t i = 0; i < one.far.size(); ++i) {
        EXPECT_EQ(one.far[i].coverage, three.far[i].coverage);
        EXPECT_EQ(one.far[i].shell_share, three.far[i].shell_share);
    }
}

/// A cloud: posts of opaque voxels two cells wide on a grid, nothing beside density.
Volume post_cloud(int side, int height) {
    Volume volume;
    volume.voxel_m = 0.01;
    volume.cells = {side, height, side};
    for (int y = 0; y < height; ++y)
        for (int z = 0; z < side; ++z)
            for (int x = 0; x < side; ++x)
                if (x % 16 < 2 && z % 16 < 2) {
                    volume.at.push_back({static_cast<std::uint16_t>(x),
                                         static_cast<std::uint16_t>(y),
                                         static_cast<std::uint16_t>(z)});
                    volume.density.push_back(1);
                }
    return volume;
}

TEST(Import, ACloudsDensityIsItsOpacity) {
    const Volume volume = post_cloud(64, 20);
    const grass::GrassSet set = import_volume(volume, small_query(), "posts.vdb");
    // Seen from above, the posts cover 4 of 256 cells; at 45 degrees a post shows its top and its
    // side as well.
    EXPECT_NEAR(set.far[0].coverage, 4.0 / 256, 0.004);
    EXPECT_GT(set.far[4].coverage, 0.1);
    EXPECT_EQ(set.levels[0].layers.width, 64);
    // Half the density lets half through.
    ImportQuery query = small_query();
    query.density = 0.01;
    Volume thin = post_cloud(64, 1);
    const grass::GrassSet faint = import_volume(thin, query, "posts.vdb");
    EXPECT_NEAR(faint.far[0].coverage, 0.01 * 4.0 / 256, 1e-4);
}

/// Share of what covers an image that texels of a species cover.
double share_of(const grass::FarLevel& level, std::size_t mip, int species) {
    const std::size_t texels =
        std::max<std::size_t>(1, static_cast<std::size_t>(level.layers.width) >> mip);
    const std::uint8_t* id =
        level.layers.mips[mip].data() + 4 * texels * texels *
                                            static_cast<std::size_t>(shared::layer_index(
                                                0, 0, level.layer_count, shared::kPlaneId));
    double own = 0, all = 0;
    for (std::size_t t = 0; t < texels * texels; ++t) {
        all += id[4 * t];
        own += id[4 * t] > 0 && shared::decode_species(id[4 * t + 3]) == species ? id[4 * t] : 0;
    }
    return own / all;
}

TEST(Import, ThinStrandsKeepTheirColour) {
    // Green posts of four cells and red ones of one, in texels as wide as two.
    Volume volume;
    volume.voxel_m = 0.01;
    volume.cells = {64, 12, 64};
    for (int y = 0; y < 12; ++y)
        for (int z = 0; z < 64; ++z)
            for (int x = 0; x < 64; ++x) {
                const bool thin = x % 8 == 6 && z % 8 == 5;
                if (!thin && (x % 8 > 1 || z % 8 > 1))
                    continue;
                volume.at.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                     static_cast<std::uint16_t>(z)});
                volume.density.push_back(1);
                const float value = 0.9f + 0.2f * static_cast<float>((x * 7 + z * 3) % 5) / 4.0f;
                volume.colour.push_back(
                    (thin ? glm::vec3(0.6f, 0.05f, 0.04f) : glm::vec3(0.08f, 0.2f, 0.03f)) * value);
            }
    ImportQuery query = small_query();
    query.size = 32;
    query.far_rays = 1024;
    const grass::GrassSet set = import_volume(volume, query, "posts.vdb");
    ASSERT_EQ(set.species.size(), 2u) << "one colour's variation is no species";
    EXPECT_NEAR(set.species[0].look.root.y, 0.2f, 0.02f);
    EXPECT_NEAR(set.species[0].look.tip.y, 0.2f, 0.02f);
    EXPECT_NEAR(set.species[1].look.root.x, 0.6f, 0.06f);
    EXPECT_NEAR(set.species[1].share, 0.2, 1e-3);
    EXPECT_NEAR(share_of(set.levels[0], 0, 1), 0.2, 0.02);
    EXPECT_NEAR(share_of(set.levels[0], 2, 1), 0.2, 0.1) << "8 texels a side";
    EXPECT_NEAR(share_of(set.levels[1], 0, 1), 0.2, 0.1) << "texels as wide as four voxels: by lot";
    volume.colour.clear();
    EXPECT_EQ(import_volume(volume, query, "posts.vdb").species.size(), 1u);
}

TEST(Import, DirectionsAreEstimatedWhereTheVolumeHasNone) {
    Volume volume;
    volume.voxel_m = 0.01;
    volume.cells = {64, 24, 64};
    std::vector<VoxelPlace> at;
    for (int y = 0; y < 24; ++y) // beams that lean by 45 degrees towards x
        for (int z = 0; z < 64; ++z)
            for (int x = 0; x < 64; ++x)
                if ((x - y + 64) % 16 < 3 && z % 16 < 3) {
                    volume.at.push_back({static_cast<std::uint16_t>(x),
                                         static_cast<std::uint16_t>(y),
                                         static_cast<std::uint16_t>(z)});
                    volume.density.push_back(1);
                }
    const VoxelField field(volume, 1);
    glm::vec3 mean(0);
    int counted = 0;
    for (std::size_t i = 0; i < field.size(); ++i)
        if (volume.at[i].y > 3 && volume.at[i].y < 20) {
            mean += field.tangent(i);
            ++counted;
        }
    mean = glm::normalize(mean);
    EXPECT_GT(counted, 100);
    EXPECT_NEAR(mean.x, std::sqrt(0.5f), 0.12f);
    EXPECT_NEAR(mean.y, std::sqrt(0.5f), 0.12f);
    EXPECT_NEAR(mean.z, 0, 0.05f);
}

TEST(Import, RefusesWhatNoPatchCanBe) {
    Volume volume = post_cloud(64, 20);
    volume.cells.z = 60;
    EXPECT_NE(error_of([&] {
                  (void)import_volume(volume, small_query(), "v.vdb");
              }).second.find("--seam"),
              std::string::npos);
    volume.cells.z = 64;
    volume.voxel_m = 100;
    EXPECT_EQ(error_of([&] { (void)import_volume(volume, small_query(), "v.vdb"); }).first,
              ExitCode::kBadInput);
    volume.voxel_m = 0.01;
    ImportQuery query = small_query();
    query.size = 2048;
    query.layers = 256;
    query.slices = 256;
    EXPECT_EQ(error_of([&] { (void)import_volume(volume, query, "v.vdb"); }).first,
              ExitCode::kOverLimit);
}

TEST(Import, AFarOnlySetIsWrittenAndRead) {
    base::set_verbosity(base::Verbosity::kQuiet);
    const fs::path folder =
        fs::temp_directory_path() / fmt::format("sward-import-test-{}", ::getpid());
    fs::create_directories(folder);
    const grass::GrassSet& made = own_import();
    Preset preset;
    preset.side_m = made.side_m;
    write_set(made, preset, folder / "set", {.volume = false, .preview = false});
    EXPECT_FALSE(fs::exists(folder / "set" / grass::kBladesFile));
    const grass::GrassSet read = grass::read_grass_set(folder / "set");
    EXPECT_TRUE(read.blades.empty());
    EXPECT_EQ(read.variant_begin, made.variant_begin);
    EXPECT_EQ(read.levels[0].layers.mips, made.levels[0].layers.mips);
    EXPECT_EQ(read.far[3].coverage, made.far[3].coverage);
    fs::remove_all(folder);
}

} // namespace
} // namespace sward::texgen
