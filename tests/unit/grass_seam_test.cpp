// SPDX-License-Identifier: Apache-2.0
// G2: joints of what comes from elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "grass_fixture.h"
#include "texgen/seam/seam_images.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_writer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using assets::LayerImage;
using base::ExitCode;

/// Strokes that cross all layers and are cut at the border: a stack that someone rendered without a
/// torus. RGBA, 8 bits.
LayerStack stroke_stack(int side, int layers, int strokes) {
    LayerStack stack;
    for (int i = 0; i < layers; ++i) {
        LayerImage image{side, side, 4, LayerImage::Type::kUint8, assets::Format::kPng, {}, {}};
        image.values.resize(static_cast<std::size_t>(side * side * 4));
        stack.images.push_back(image);
        stack.files.emplace_back(fmt::format("layer{}.png", i));
    }
    for (int s = 0; s < strokes; ++s) {
        const auto random = [&](std::uint64_t n) {
            return base::hash_unit(3, n, static_cast<std::uint64_t>(s));
        };
        const double x = random(0) * side, z = random(1) * side, turn = random(2) * 6.2832,
                     lean = 0.2 + random(3);
        for (int i = 0; i < layers; ++i)
            for (double t = 0; t < 9; t += 0.2)
                for (double w = -1; w <= 1; w += 0.5) {
                    const double out = (i * 9 + t) * lean;
                    const int u =
                        static_cast<int>(std::floor(x + out * std::cos(turn) - w * std::sin(turn)));
                    const int v =
                        static_cast<int>(std::floor(z + out * std::sin(turn) + w * std::cos(turn)));
                    if (u < 0 || v < 0 || u >= side || v >= side)
                        continue;
                    float* p = &stack.images[static_cast<std::size_t>(i)]
                                    .values[static_cast<std::size_t>((v * side + u) * 4)];
                    p[0] = 60 + static_cast<float>(s % 60);
                    p[1] = 120 + static_cast<float>(s % 90);
                    p[2] = 40;
                    p[3] = 255;
                }
    }
    return stack;
}

/// Mean alpha gradient between columns u - 1 and u, over all layers.
double column_gradient(const LayerStack& stack, int u) {
    double sum = 0;
    for (const LayerImage& image : stack.images)
        for (int v = 0; v < image.height; ++v) {
            const auto at = [&](int x) {
                const int w = image.width;
                return image.values[static_cast<std::size_t>((v * w + (x + w) % w) * 4 + 3)];
            };
            sum += std::abs(at(u) - at(u - 1));
        }
    return sum / stack.images.front().height;
}

double median_gradient(const LayerStack& stack) {
    std::vector<double> all;
    for (int u = 1; u < stack.images.front().width; ++u)
        all.push_back(column_gradient(stack, u));
    std::ranges::sort(all);
    return all[all.size() / 2];
}

/// G2 as printed: the larger alpha over the whole border.
LayerStack plain_g2(const LayerStack& stack, int cut) {
    LayerStack out = stack;
    for (LayerImage& image : out.images) {
        const LayerImage from = image;
        image.width -= cut;
        for (int v = 0; v < from.height; ++v)
            for (int u = 0; u < image.width; ++u)
                for (int c = 0; c < 4; ++c) {
                    const auto at = [&](int x, int k) {
                        return from.values[static_cast<std::size_t>((v * from.width + x) * 4 + k)];
                    };
                    const bool over = u < cut && at(u + image.width, 3) >= at(u, 3);
                    image.values[static_cast<std::size_t>((v * image.width + u) * 4 + c)] =
                        at(over ? u + image.width : u, c);
                }
    }
    return out;
}

TEST(Seam, LowersTheJointToTheInterior) {
    const LayerStack stack = stroke_stack(256, 6, 700);
    const LayerStack done = seam_stack(stack, {.share = 0.125});
    EXPECT_EQ(done.images.front().width, 224);
    EXPECT_EQ(done.images.front().height, 224);
    EXPECT_GT(measure_stack(stack).ratio(), 1.4) << "the test's stack must show its joint";
    EXPECT_LE(measure_stack(done).ratio(), kMostJointRatio);
    // Nor does the overlap's inner end, or any column of it, stand out; the printed method's does.
    const double median = median_gradient(done);
    double mean = 0;
    for (int u = 0; u <= 33; ++u) {
        EXPECT_LE(column_gradient(done, u), 1.6 * median)
            << u; // single columns of the source go as high
        mean += column_gradient(done, u) / 34;
    }
    EXPECT_LE(mean, kMostJointRatio * median);
    EXPECT_LE(column_gradient(done, 32), kMostJointRatio * median);
    const LayerStack plain = plain_g2(stack, 32);
    EXPECT_GT(column_gradient(plain, 32), 1.3 * median_gradient(plain));
}

TEST(Seam, ATexelStaysWhole) {
    const LayerStack stack = stroke_stack(96, 3, 90);
    const LayerStack done = seam_stack(stack, {.texels = 12});
    for (std::size_t l = 0; l < 3; ++l)
        for (int v = 0; v < 84; ++v)
            for (int u = 0; u < 84; ++u) {
                const auto texel = [&](const LayerImage& image, int x, int y) {
                    return &image.values[static_cast<std::size_t>((y * image.width + x) * 4)];
                };
                bool known = false;
                for (const int x : {u, u + 84})
                    for (const int y : {v, v + 84})
                        known |=
                            x < 96 && y < 96 &&
                            std::equal(texel(done.images[l], u, v), texel(done.images[l], u, v) + 4,
                                       texel(stack.images[l], x, y));
                ASSERT_TRUE(known) << u << " " << v;
                if (u >= 12 && v >= 12) {
                    ASSERT_TRUE(std::equal(texel(done.images[l], u, v),
                                           texel(done.images[l], u, v) + 4,
                                           texel(stack.images[l], u, v)));
                }
            }
}

TEST(Seam, TheBoundariesTakeTheFreeWayAndClose) {
    // One free column that wanders; everything else costs.
    OverlapCost cost{16, 40, {}, {}};
    cost.over.assign(16 * 40, 1);
    cost.under.assign(16 * 40, 1);
    for (int row = 0; row < 40; ++row) {
        const int x = 3 + (row < 20 ? row / 5 : (39 - row) / 5);
        cost.over[static_cast<std::size_t>(row * 16 + x)] = 0;
    }
    for (const bool closed : {false, true}) {
        const Overlap overlap = find_overlap(cost, closed);
        for (int row = 0; row < 40; ++row) {
            const auto r = static_cast<std::size_t>(row);
            EXPECT_GE(overlap.over[r], 1);
            EXPECT_LE(overlap.over[r], overlap.under[r]);
            EXPECT_LE(overlap.under[r], 15);
            const std::size_t next = (r + 1) % 40;
            if (closed || next > 0) {
                EXPECT_LE(std::abs(overlap.over[r] - overlap.over[next]), 1);
                EXPECT_LE(std::abs(overlap.under[r] - overlap.under[next]), 1);
            }
        }
    }
}

TEST(Seam, RefusesCutsThatLeaveTooLittle) {
    const LayerStack stack = stroke_stack(32, 1, 5);
    for (const SeamCut cut : {SeamCut{.share = 0.5}, SeamCut{.texels = 2}, SeamCut{.texels = 31},
                              SeamCut{.share = 0.01}})
        EXPECT_EQ(error_of([&] { (void)seam_stack(stack, cut); }).first, ExitCode::kUsage);
}

/// A square of upright and leaning strands in a box, cut at its sides.
Volume strand_volume(int side, int height, int strands) {
    std::map<std::tuple<int, int, int>, float> cells;
    for (int s = 0; s < strands; ++s) {
        const auto random = [&](std::uint64_t n) {
            return base::hash_unit(5, n, static_cast<std::uint64_t>(s));
        };
        const double x = random(0) * side, z = random(1) * side, turn = random(2) * 6.2832,
                     lean = random(3);
        for (int y = 0; y < height; ++y) {
            const int u = static_cast<int>(std::floor(x + y * lean * std::cos(turn)));
            const int v = static_cast<int>(std::floor(z + y * lean * std::sin(turn)));
            if (u >= 0 && v >= 0 && u < side && v < side)
                cells[{y, v, u}] = 0.25f + 0.5f * static_cast<float>(random(4));
        }
    }
    Volume volume;
    volume.voxel_m = 0.01;
    volume.cells = {side, height, side};
    for (const auto& [at, density] : cells) {
        const auto [y, z, x] = at;
        volume.at.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                             static_cast<std::uint16_t>(z)});
        volume.density.push_back(density);
        volume.colour.push_back({density, 0.1f, static_cast<float>(x) / 512});
    }
    return volume;
}

TEST(Seam, AVolumeBecomesPeriodicAndKeepsItsVoxelsTogether) {
    const Volume volume = strand_volume(128, 24, 900);
    const Volume done = seam_volume(volume, {.share = 0.125}, "v.vdb");
    EXPECT_EQ(done.cells, glm::ivec3(112, 24, 112));
    EXPECT_NEAR(done.period_m, 1.12, 1e-9);
    const auto measure = [](const Volume& v) {
        std::vector<glm::ivec3> at;
        for (const VoxelPlace& p : v.at)
            at.emplace_back(p.x, p.y, p.z);
        return measure_cells({at, v.density, 1, {0, 0, 0}, v.cells, {}}).ratio();
    };
    EXPECT_GT(measure(volume), 1.1);
    EXPECT_LE(measure(done), kMostJointRatio);
    ASSERT_EQ(done.at.size(), done.colour.size());
    for (std::size_t i = 0; i < done.at.size(); ++i)
        ASSERT_EQ(done.colour[i].x, done.density[i]); // a voxel's companions came with it
    for (std::size_t i = 1; i < done.at.size(); ++i)
        ASSERT_TRUE(std::tie(done.at[i - 1].y, done.at[i - 1].z, done.at[i - 1].x) <
                    std::tie(done.at[i].y, done.at[i].z, done.at[i].x));
}

TEST(Seam, AVdbFileKeepsItsGridsAndGetsItsPeriod) {
    const Volume volume = strand_volume(64, 8, 200);
    const std::vector<std::byte> bytes = encode_vdb(volume);
    const VdbFile file(bytes, "in.vdb");
    const VdbCells cells = file.read_cells();
    EXPECT_EQ(cells.key_grid, "density");
    ASSERT_EQ(cells.at.size(), volume.at.size());
    const std::vector<VdbMove> moves = {{cells.at[5], {1, 2, 3}}, {cells.at[6], {4, 5, 6}}};
    const std::vector<std::byte> out = file.moved(moves, 0.64);
    const Volume read = VdbFile(out, "out.vdb").read_volume({});
    ASSERT_EQ(read.at.size(), 2u);
    EXPECT_NEAR(read.period_m, 0.64, 1e-6);
    EXPECT_EQ(read.colour.size(), 2u);
    EXPECT_NEAR(read.density[0], cells.key[5], 1e-6);
    EXPECT_NEAR(read.density[1], cells.key[6], 1e-6);
}

class StackFiles : public ::testing::Test {
protected:
    StackFiles()
        : folder_(fs::temp_directory_path() / fmt::format("sward-stack-test-{}", ::getpid())) {
        fs::create_directories(folder_);
    }
    ~StackFiles() override { fs::remove_all(folder_); }
    void write(const LayerImage& image, const std::string& name) {
        base::write_file_atomic(folder_ / name, assets::encode_layer_image(image, name));
    }
    fs::path folder_;
};

TEST_F(StackFiles, EveryKindOfPictureComesBackAsItWas) {
    using Type = LayerImage::Type;
    using assets::Format;
    for (const auto& [format, type] : {std::pair{Format::kPng, Type::kUint8},
                                       {Format::kPng, Type::kUint16},
                                       {Format::kTiff, Type::kUint8},
                                       {Format::kTiff, Type::kUint16},
                                       {Format::kTiff, Type::kFloat},
                                       {Format::kExr, Type::kHalf},
                                       {Format::kExr, Type::kFloat}})
        for (int channels = 1; channels <= 4; ++channels) {
            LayerImage image{7, 5, channels, type, format, {}, {}};
            if (format == Format::kExr)
                image.names = std::vector<std::string>{"R", "G", "B", "A"};
            image.names.resize(format == Format::kExr ? static_cast<std::size_t>(channels) : 0);
            const float scale = type == Type::kUint8    ? 7.0f
                                : type == Type::kUint16 ? 1801.0f
                                                        : 0.125f;
            for (int i = 0; i < 35 * channels; ++i)
                image.values.push_back(scale * static_cast<float>(i % 36));
            write(image, "a.img");
            const LayerImage read = assets::read_layer_image(folder_ / "a.img");
            EXPECT_EQ(read.width, 7);
            EXPECT_EQ(read.height, 5);
            EXPECT_EQ(read.channels, channels);
            EXPECT_EQ(read.type, type);
            EXPECT_EQ(read.names, image.names);
            EXPECT_EQ(read.values, image.values)
                << static_cast<int>(format) << " " << static_cast<int>(type) << " " << channels;
        }
}

TEST_F(StackFiles, AStackIsADirectoryOrAPatternOfEqualPictures) {
    const LayerStack stack = stroke_stack(32, 12, 5);
    for (int i = 0; i < 12; ++i)
        write(stack.images[static_cast<std::size_t>(i)], fmt::format("l{}.png", i));
    base::write_file_atomic(folder_ / "notes.txt", std::string("x"));
    const LayerStack all = read_stack(folder_);
    ASSERT_EQ(all.files.size(), 12u);
    EXPECT_EQ(all.files[2].filename(), "l2.png"); // not l10
    EXPECT_EQ(all.images[11].values, stack.images[11].values);
    EXPECT_EQ(read_stack(folder_ / "l%d.png").files.size(), 12u);
    EXPECT_EQ(read_stack(folder_ / "l3.png").files.size(), 1u);
    EXPECT_EQ(error_of([&] { (void)read_stack(folder_ / "m%d.png"); }).first, ExitCode::kIo);
    EXPECT_EQ(error_of([&] { (void)read_stack(folder_ / "l%s.png"); }).first, ExitCode::kBadInput);
    EXPECT_EQ(error_of([&] { (void)read_stack(folder_ / "none"); }).first, ExitCode::kIo);
    EXPECT_EQ(error_of([&] { (void)read_stack(folder_ / "notes.txt"); }).first,
              ExitCode::kBadInput);
    write(stroke_stack(33, 1, 5).images.front(), "l5.png");
    const auto [code, text] = error_of([&] { (void)read_stack(folder_); });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("l5.png"), std::string::npos) << text;
    EXPECT_NE(text.find("33 x 33"), std::string::npos) << text;
}

TEST_F(StackFiles, NanIsRefusedByPlace) {
    LayerImage image{4,
                     3,
                     1,
                     LayerImage::Type::kFloat,
                     assets::Format::kExr,
                     {"Y"},
                     std::vector<float>(12, 1.0f)};
    image.values[6] = NAN;
    write(image, "nan.exr");
    const auto [code, text] =
        error_of([&] { (void)assets::read_layer_image(folder_ / "nan.exr"); });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("column 2, row 1"), std::string::npos) << text;
}

} // namespace
} // namespace sward::texgen
