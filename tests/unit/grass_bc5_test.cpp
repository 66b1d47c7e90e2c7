// SPDX-License-Identifier: Apache-2.0
// BC5 against brute force over every pair of end points, and against a decoder written from the
// format's text in another way.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/hash.h"
#include "grass/bc5.h"
#include "grass/ktx2.h"
#include "grass_fixture.h"

namespace sward::texgen {
namespace {

using grass::Bc4Block;
using Values = std::array<std::uint8_t, 16>;

double error_with(const Values& values, std::uint16_t used, int end0, int end1) {
    const std::array<double, 8> palette =
        grass::bc4_palette(static_cast<std::uint8_t>(end0), static_cast<std::uint8_t>(end1));
    double sum = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        double least = 1e9;
        for (const double p : palette)
            least = std::min(least, std::pow(p * 255 - values[i], 2));
        sum += used >> i & 1 ? least : 0;
    }
    return sum;
}

double least_error(const Values& values, std::uint16_t used) {
    double least = 1e9;
    for (int a = 0; a < 256; ++a)
        for (int b = 0; b < 256; ++b)
            least = std::min(least, error_with(values, used, a, b));
    return least;
}

double error_of_block(const Bc4Block& block, const Values& values, std::uint16_t used) {
    const std::array<double, 8> palette = grass::bc4_palette(block[0], block[1]);
    double sum = 0;
    for (int i = 0; i < 16; ++i)
        if (used >> i & 1)
            sum += std::pow(palette[static_cast<std::size_t>(grass::bc4_index(block, i))] * 255 -
                                values[static_cast<std::size_t>(i)],
                            2);
    return sum;
}

/// Squared error of our blocks over the least that is possible, summed over blocks; and the worst
/// block's.
struct Score {
    double ours = 0, least = 0, worst = 1;
    void add(const Values& values, std::uint16_t used) {
        const double own = error_of_block(grass::encode_bc4(values, used), values, used);
        const double best = least_error(values, used);
        EXPECT_GE(own, best - 1e-6);
        ours += own;
        least += best;
        if (best > 16) // a squared step a texel: below it no eye tells
            worst = std::max(worst, own / best);
    }
};

TEST(Bc4, NearTheLeastErrorOnRandomBlocks) {
    Score uniform, narrow, blades;
    for (std::uint64_t n = 0; n < 40; ++n) {
        const auto random = [&](std::uint64_t k) { return base::hash_unit(n, 77, k); };
        Values a{}, b{}, c{};
        for (std::size_t i = 0; i < 16; ++i) {
            a[i] = static_cast<std::uint8_t>(random(i) * 256);
            b[i] = static_cast<std::uint8_t>(90 + random(20 + i) * 40);
            // Two blades: each a slope of its own.
            const auto row = static_cast<double>(i / 4);
            const double blade = random(40 + i % 4) < 0.5 ? 30 + 4 * row : 190 - 3 * row;
            c[i] = static_cast<std::uint8_t>(blade + random(60) * 20);
        }
        const auto used = static_cast<std::uint16_t>(base::hash64(n, 78, 0));
        uniform.add(a, used);
        narrow.add(b, used);
        blades.add(c, used);
    }
    for (const Score& score :
         {uniform, narrow, blades}) { // the descent ends in a hollow now and then
        EXPECT_LT(score.ours, 1.2 * score.least);
        EXPECT_LT(score.worst, 3);
    }
}

TEST(Bc4, NearTheLeastErrorOnAGrassSetsBlocks) {
    const grass::TextureArray& array = small_set().levels[0].layers;
    const std::size_t bytes = grass::mip_bytes(array, 0) / static_cast<std::size_t>(array.layers);
    Score score;
    int blocks = 0;
    for (std::uint64_t n = 0; blocks < 60 && n < 100000; ++n) {
        const auto image = base::hash64(n, 1, 0) % static_cast<std::size_t>(array.layers / 2);
        const auto x = base::hash64(n, 2, 0) % 63 * 4, y = base::hash64(n, 3, 0) % 63 * 4;
        const std::uint8_t* id = array.mips[0].data() + 2 * image * bytes;
        Values values{};
        std::uint16_t used = 0;
        for (std::size_t i = 0; i < 16; ++i) {
            const std::size_t t = (y + i / 4) * 256 + x + i % 4;
            values[i] = id[bytes + 4 * t + n % 4];
            used = static_cast<std::uint16_t>(used | (id[4 * t] > 0 ? 1u << i : 0u));
        }
        if (std::popcount(used) < 6)
            continue;
        score.add(values, used);
        ++blocks;
    }
    EXPECT_EQ(blocks, 60);
    EXPECT_GT(score.least, 0);
    RecordProperty("ratio", std::to_string(score.ours / score.least));
    EXPECT_LT(score.ours, 1.1 * score.least); // measured 1.05
}

TEST(Bc4, KeepsFewAndNarrowValuesExactly) {
    for (int low = 0; low < 256; ++low)
        for (const int span : {0, 1, 3, 7}) {
            Values values{};
            for (std::size_t i = 0; i < 16; ++i)
                values[i] = static_cast<std::uint8_t>(
                    std::min(255, low + static_cast<int>(i) % (span + 1)));
            EXPECT_EQ(grass::decode_bc4(grass::encode_bc4(values, 0xFFFF)), values) << low << span;
        }
    Values ends{};
    for (std::size_t i = 0; i < 16; ++i) // both ends of the scale and a narrow middle
        ends[i] = static_cast<std::uint8_t>(i % 3 == 0 ? 0 : i % 3 == 1 ? 255 : 130 + i % 5);
    EXPECT_EQ(grass::decode_bc4(grass::encode_bc4(ends, 0xFFFF)), ends);
}

TEST(Bc4, DecodesAsTheFormatSays) {
    // Indices 0..7, 0..7 as a 48-bit little-endian number of 3-bit fields: 0xFAC688, twice.
    const Bc4Block eight{200, 60, 0x88, 0xC6, 0xFA, 0x88, 0xC6, 0xFA};
    EXPECT_EQ(grass::decode_bc4(eight),
              (Values{200, 60, 180, 160, 140, 120, 100, 80, 200, 60, 180, 160, 140, 120, 100, 80}));
    const Bc4Block six{50, 200, 0x88, 0xC6, 0xFA, 0x88, 0xC6, 0xFA};
    EXPECT_EQ(grass::decode_bc4(six),
              (Values{50, 200, 80, 110, 140, 170, 0, 255, 50, 200, 80, 110, 140, 170, 0, 255}));
    const Bc4Block equal{77, 77, 0x88, 0xC6, 0xFA, 0x88, 0xC6, 0xFA};
    EXPECT_EQ(grass::decode_bc4(equal)[6], 0);
    EXPECT_EQ(grass::decode_bc4(equal)[5], 77);
}

TEST(Bc5, PlanesPartAndJoinAgain) {
    grass::TextureArray planes = small_set().levels[1].slices;
    const grass::TextureArray before = planes;
    grass::TextureArray shapes = grass::empty_shapes(planes);
    for (int i = 0; i < planes.layers / 2; ++i)
        grass::compress_shape(planes, i, shapes);
    const grass::TextureArray ids = grass::id_planes(before);
    EXPECT_EQ(grass::join_planes(ids, shapes).mips,
              planes.mips); // a reader gets what the writer has
    double sum = 0;
    std::size_t used = 0;
    const std::size_t bytes = grass::mip_bytes(planes, 0) / static_cast<std::size_t>(planes.layers);
    for (std::size_t t = 0; t < before.mips[0].size(); ++t) {
        if (t / bytes % 2 == 0) {
            ASSERT_EQ(before.mips[0][t], planes.mips[0][t]); // ids stay
        } else if (before.mips[0][t - t % 4 - bytes] > 0) {
            sum += std::pow(before.mips[0][t] - planes.mips[0][t], 2);
            ++used;
        }
    }
    EXPECT_GT(used, 10000u);
    EXPECT_LT(std::sqrt(sum / static_cast<double>(used)), 3.5); // of 255; measured 2.3
    const std::vector<std::byte> file = grass::encode_ktx2(shapes, 3);
    const grass::TextureArray back = grass::decode_ktx2(file, "shape.ktx2");
    EXPECT_EQ(back.format, grass::TexelFormat::kBc5);
    EXPECT_EQ(back.mips, shapes.mips);
}

} // namespace
} // namespace sward::texgen
