// SPDX-License-Identifier: Apache-2.0
// The files of a set: what is written is read back, what is damaged is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "grass/blades_glb.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "grass_fixture.h"
#include "texgen/bake/check_nan.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;
using shared::BladeRecord;

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

TEST(Ktx2, RoundTripKeepsEveryByte) {
    const grass::TextureArray array = noise_array(40, 12, 6);
    const std::vector<std::byte> bytes = grass::encode_ktx2(array, 3);
    const grass::TextureArray back = grass::decode_ktx2(bytes, "a.ktx2");
    EXPECT_EQ(back.width, 40);
    EXPECT_EQ(back.height, 12);
    EXPECT_EQ(back.layers, 6);
    EXPECT_EQ(back.mips, array.mips);
}

grass::TextureArray noise_of(grass::TexelFormat format) {
    grass::TextureArray array{40, 12, 3, {}, format};
    for (int m = 0; m < 4; ++m) {
        array.mips.emplace_back(grass::mip_bytes(array, m));
        for (std::size_t i = 0; i < array.mips.back().size();
             ++i) // 0x3F at every fourth: finite floats
            array.mips.back()[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 0x3F : i * 37 % 251);
    }
    return array;
}

TEST(Ktx2, EveryFormatWithAndWithoutZstd) {
    for (const auto& [format, vk, mip1] :
         {std::tuple{grass::TexelFormat::kRgba8, 37, 20 * 6 * 3 * 4},
          std::tuple{grass::TexelFormat::kRgba8Srgb, 43, 20 * 6 * 3 * 4},
          std::tuple{grass::TexelFormat::kRgba32f, 109, 20 * 6 * 3 * 16},
          std::tuple{grass::TexelFormat::kBc5, 141, 5 * 2 * 3 * 16}})
        for (const int level : {0, 3}) {
            const grass::TextureArray array = noise_of(format);
            EXPECT_EQ(grass::mip_bytes(array, 1), mip1);
            const std::vector<std::byte> bytes = grass::encode_ktx2(array, level);
            std::uint32_t header[12];
            std::memcpy(header, bytes.data() + 12, sizeof header);
            EXPECT_EQ(header[0], vk);
            EXPECT_EQ(header[8], level == 0 ? 0u : 2u);
            const grass::TextureArray back = grass::decode_ktx2(bytes, "a.ktx2");
            EXPECT_EQ(back.format, format);
            EXPECT_EQ(back.mips, array.mips);
            for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 7 : 211)
                EXPECT_EQ(error_of([&] {
                              (void)grass::decode_ktx2(std::span(bytes).first(size), "cut.ktx2");
                          }).first,
                          ExitCode::kBadInput)
                    << size;
            if (level == 0) { // every mip lies at a multiple of the block
                for (int m = 0; m < 4; ++m) {
                    std::uint64_t offset = 0;
                    std::memcpy(&offset, bytes.data() + 80 + 24 * m, sizeof offset);
                    EXPECT_EQ(offset % (mip1 == 20 * 6 * 3 * 4 ? 4 : 16), 0u);
                }
                std::vector<std::byte> bad = bytes;
                bad[80] ^= std::byte{2};
                EXPECT_EQ(error_of([&] { (void)grass::decode_ktx2(bad, "odd.ktx2"); }).first,
                          ExitCode::kBadInput);
            }
        }
}

TEST(Ktx2, RefusesNanAndDescriptorsOfOtherFormats) {
    grass::TextureArray array = noise_of(grass::TexelFormat::kRgba32f);
    const float nan = std::nanf("");
    std::memcpy(array.mips[2].data() + 16, &nan, sizeof nan);
    const auto [code, text] =
        error_of([&] { (void)grass::decode_ktx2(grass::encode_ktx2(array, 3), "nan.ktx2"); });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("finite"), std::string::npos) << text;
    std::vector<std::byte> bytes = grass::encode_ktx2(noise_of(grass::TexelFormat::kBc5), 0);
    bytes[12] = std::byte{37}; // says RGBA8, and describes BC5
    EXPECT_EQ(error_of([&] { (void)grass::decode_ktx2(bytes, "mixed.ktx2"); }).first,
              ExitCode::kBadInput);
}

/// Words of the data format descriptors, counted out by hand from Khronos Data Format 1.3.
TEST(Ktx2, DescriptorsAreThoseOfTheFormat) {
    const auto word = [](const std::vector<std::byte>& bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    };
    const std::vector<std::byte> bc = grass::encode_ktx2(noise_of(grass::TexelFormat::kBc5), 3);
    std::size_t dfd = word(bc, 48);
    EXPECT_EQ(word(bc, dfd), 60u);                // 4 + 24 + 2 * 16
    EXPECT_EQ(word(bc, dfd + 8), 2u | 56u << 16); // version 1.3, block size
    EXPECT_EQ(word(bc, dfd + 12), 0x00010184u);   // BC5, BT.709, linear
    EXPECT_EQ(word(bc, dfd + 16), 0x0303u);       // 4 x 4
    EXPECT_EQ(word(bc, dfd + 20), 16u);           // bytes of plane 0
    EXPECT_EQ(word(bc, dfd + 28), 63u << 16);     // red: bits 0..63
    EXPECT_EQ(word(bc, dfd + 40), 0xFFFFFFFFu);
    EXPECT_EQ(word(bc, dfd + 44), 64u | 63u << 16 | 1u << 24); // green
    const std::vector<std::byte> real =
        grass::encode_ktx2(noise_of(grass::TexelFormat::kRgba32f), 0);
    dfd = word(real, 48);
    EXPECT_EQ(word(real, 16), 4u); // type size
    EXPECT_EQ(word(real, dfd + 12), 0x00010101u);
    EXPECT_EQ(word(real, dfd + 28), 0xC01F0000u);                // red, signed float, 32 bits
    EXPECT_EQ(word(real, dfd + 28 + 3 * 16), 0xCF1F0000u | 96u); // alpha
    EXPECT_EQ(word(real, dfd + 36), 0xBF800000u);                // -1
    EXPECT_EQ(word(real, dfd + 40), 0x3F800000u);                // 1
    const std::vector<std::byte> srgb =
        grass::encode_ktx2(noise_of(grass::TexelFormat::kRgba8Srgb), 0);
    dfd = word(srgb, 48);
    EXPECT_EQ(word(srgb, dfd + 12), 0x00020101u);                // RGBSDA, BT.709, sRGB
    EXPECT_EQ(word(srgb, dfd + 28), 7u << 16);                   // red
    EXPECT_EQ(word(srgb, dfd + 28 + 3 * 16), 0x1F070000u | 24u); // alpha, linear
}

TEST(Ktx2, ASingleTextureIsNoArrayAndMayBeLarger) {
    grass::TextureArray atlas{4096, 8, 1, {}, grass::TexelFormat::kRgba8Srgb, true};
    atlas.mips.emplace_back(grass::mip_bytes(atlas, 0), std::uint8_t{7});
    const std::vector<std::byte> bytes = grass::encode_ktx2(atlas, 3);
    std::uint32_t layers = 1;
    std::memcpy(&layers, bytes.data() + 32, sizeof layers);
    EXPECT_EQ(layers, 0u);
    const grass::TextureArray back = grass::decode_ktx2(bytes, "atlas.ktx2");
    EXPECT_TRUE(back.plain);
    EXPECT_EQ(back.layers, 1);
    EXPECT_EQ(back.mips, atlas.mips);
    atlas.plain = false;
    EXPECT_EQ(error_of([&] {
                  (void)grass::decode_ktx2(grass::encode_ktx2(atlas, 3), "wide.ktx2");
              }).first,
              ExitCode::kOverLimit);
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
    ASSERT_EQ(read.species.size(), made.species.size());
    for (std::size_t s = 0; s < made.species.size(); ++s) {
        EXPECT_EQ(read.species[s].name, made.species[s].name);
        EXPECT_EQ(
            std::memcmp(&read.species[s].look, &made.species[s].look, sizeof made.species[s].look),
            0);
    }
    for (std::size_t k = 0; k < made.levels.size(); ++k) {
        EXPECT_EQ(read.levels[k].layer_edges, made.levels[k].layer_edges);
        EXPECT_EQ(read.levels[k].layer_heights, made.levels[k].layer_heights);
    }
    ASSERT_EQ(read.levels.size(), made.levels.size());
    for (std::size_t k = 0; k < read.levels.size(); ++k) {
        EXPECT_EQ(read.levels[k].layers.mips, made.levels[k].layers.mips);
        EXPECT_EQ(read.levels[k].slices.mips, made.levels[k].slices.mips);
    }
    ASSERT_EQ(read.far.size(), made.far.size());
    for (std::size_t i = 0; i < read.far.size(); ++i) {
        EXPECT_EQ(read.far[i].coverage, made.far[i].coverage);
        EXPECT_EQ(read.far[i].shell_share, made.far[i].shell_share);
        EXPECT_EQ(read.far[i].coarse_shares, made.far[i].coarse_shares);
    }
    EXPECT_EQ(std::memcmp(read.blades.data(), made.blades.data(),
                          made.blades.size() * sizeof(BladeRecord)),
              0);
}

TEST(GrassSet, BlockCompressedReadsBackAsItsTexelsDecode) {
    base::set_verbosity(base::Verbosity::kQuiet);
    const Folder folder;
    Preset preset = small_meadow();
    preset.size = 128;
    const BakeOptions options{.volume = false, .preview = false, .block = true, .check_nan = true};
    const grass::GrassSet made = bake_set(preset, options);
    const fs::path path = folder.path() / "set";
    write_set(made, preset, path, options);
    const grass::GrassSet read = grass::read_grass_set(path);
    ASSERT_EQ(read.levels.size(), made.levels.size());
    for (std::size_t k = 0; k < read.levels.size(); ++k) {
        EXPECT_EQ(read.levels[k].layers.mips, made.levels[k].layers.mips);
        EXPECT_EQ(read.levels[k].slices.mips, made.levels[k].slices.mips);
        EXPECT_EQ(read.levels[k].layers_shape.mips, made.levels[k].layers_shape.mips);
        EXPECT_EQ(read.levels[k].slices_shape.mips, made.levels[k].slices_shape.mips);
        EXPECT_FALSE(read.levels[k].layers_shape.mips.empty());
    }
    // A set that says BC5 at one level only, or whose shapes are those of another level.
    const std::string json = base::read_text(path / grass::kSetJson, 1 << 20);
    const std::string key = "\"layers_shape\"";
    base::write_file_atomic(path / grass::kSetJson,
                            std::string(json).replace(json.rfind(key), key.size(), "\"other\""));
    EXPECT_EQ(error_of([&] { (void)grass::read_grass_set(path); }).first, ExitCode::kBadInput);
    const auto entry = [&](const char* name) {
        const std::size_t at = json.find("\"" + std::string(name) + "\": {");
        return json.substr(at, json.find('}', at) - at);
    };
    std::string swapped = json;
    const std::string mine = entry("layers_shape.ktx2"), others = entry("slices_shape.ktx2");
    swapped.replace(swapped.find(mine), mine.size(),
                    "\"layers_shape.ktx2\"" + others.substr(others.find(':')));
    base::write_file_atomic(path / grass::kSetJson, swapped);
    fs::copy_file(path / "slices_shape.ktx2", path / "layers_shape.ktx2",
                  fs::copy_options::overwrite_existing);
    const auto [code, text] = error_of([&] { (void)grass::read_grass_set(path); });
    EXPECT_EQ(code, ExitCode::kBadInput);
    EXPECT_NE(text.find("layers_shape.ktx2"), std::string::npos) << text;
}

TEST(GrassSet, CheckNanFindsWhatIsNotFinite) {
    const grass::GrassSet good = small_set();
    EXPECT_GT(check_finite(good), good.blades.size() * 16);
    const auto refused = [&](const auto& spoil) {
        grass::GrassSet set = good;
        spoil(set);
        return error_of([&] { (void)check_finite(set); }).first == ExitCode::kFailure;
    };
    const float nan = std::nanf(""), infinite = HUGE_VALF;
    EXPECT_TRUE(refused([&](grass::GrassSet& set) { set.blades[5].v2.z = nan; }));
    EXPECT_TRUE(refused([&](grass::GrassSet& set) { set.far[1].coarse_shares[0] = infinite; }));
    EXPECT_TRUE(refused([&](grass::GrassSet& set) { set.levels[1].layer_heights[0] = nan; }));
    EXPECT_TRUE(refused([&](grass::GrassSet& set) { set.species[0].look.tip.y = -infinite; }));
    EXPECT_TRUE(refused([&](grass::GrassSet& set) { set.canopy_m = nan; }));
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
    const std::string json = base::read_text(set / grass::kSetJson, 1 << 20);
    const auto altered = [&](const std::string& from, const std::string& to) {
        return std::string(json).replace(json.find(from), from.size(), to);
    };
    const std::string version = fmt::format("\"version\": {}", grass::kSetFormatVersion);
    for (const std::string& text :
         {altered(version, "\"version\": 99"),
          altered("\"shell_share\": [", "\"shell_share\": [0.5,"),
          altered("\"shell_share\": [", "\"shell_share\": [1.5],\"b\":["),
          altered("\"levels\": [", "\"shells\": ["), json.substr(0, json.size() / 2),
          std::string(5000, '['), std::string("{}"), std::string()}) {
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
