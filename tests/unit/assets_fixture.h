// SPDX-License-Identifier: Apache-2.0
// Files that the tests of assets make for themselves, byte by byte, so that they can be wrong too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <locale>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assets/assets.h"
#include "base/error.h"
#include "base/file.h"

namespace sward::assets::tests {

namespace fs = std::filesystem;
using base::ExitCode;
using scene::Heightfield;
using scene::TerrainSpec;

class TempDir {
public:
    TempDir() {
        std::string name = (fs::temp_directory_path() / "sward_assets_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TempDir() { fs::remove_all(path_); }
    fs::path operator/(const fs::path& name) const { return path_ / name; }
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

inline void put(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}
inline std::string get(const fs::path& path) {
    return base::read_text(path, 1 << 26);
}

/// The message of the error that `act` throws; nothing else may reach stderr.
inline std::string error_of(const std::function<void()>& act, ExitCode code = ExitCode::kBadInput) {
    std::string message = "no error";
    testing::internal::CaptureStderr();
    try {
        act();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        message = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "")
        << "noise of a library, beside: " << message;
    return message;
}

inline void expect_holds(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

template<class T> std::string little(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
}

/// A small uncompressed TIFF, with GeoTIFF keys where asked: written here byte by byte, so that it
/// can be wrong too.
struct Tiff {
    std::uint32_t width = 2, height = 2;
    std::string data;
    std::uint16_t bits = 16, format = 2; ///< 1 unsigned, 2 signed, 3 floating point
    std::uint16_t samples = 1;
    std::vector<double> matrix; ///< ModelTransformationTag, 16 numbers
    std::vector<std::uint16_t> geokeys;
    std::string nodata;
    std::string metadata;   ///< GDAL_METADATA
    bool alpha = false;     ///< the last sample of a pixel
    std::string inner_mask; ///< a byte a pixel, 0 where there is no value: written as a second
                            ///< picture of one bit

    [[nodiscard]] std::string bytes() const {
        struct Entry {
            std::uint16_t tag, type;
            std::uint32_t count;
            std::string value;
        };
        std::vector<Entry> entries;
        const auto number = [&](std::uint16_t tag, std::uint32_t value) {
            entries.push_back({tag, 4, 1, little(value)});
        };
        const auto text = [&](std::uint16_t tag, const std::string& value) {
            entries.push_back({tag, 2, static_cast<std::uint32_t>(value.size() + 1), value + '\0'});
        };
        std::string bit_list, format_list;
        for (int i = 0; i < samples; ++i)
            bit_list += little(bits), format_list += little(format);
        number(256, width);
        number(257, height);
        entries.push_back({258, 3, samples, bit_list});
        number(259, 1);
        number(262, 1);
        number(273, 8);
        number(277, samples);
        number(278, height);
        number(279, static_cast<std::uint32_t>(data.size()));
        if (alpha)
            entries.push_back({338, 3, 1, little(std::uint16_t{2})});
        entries.push_back({339, 3, samples, format_list});
        if (!matrix.empty()) {
            std::string values;
            for (const double v : matrix)
                values += little(v);
            entries.push_back({34264, 12, static_cast<std::uint32_t>(matrix.size()), values});
        }
        if (!geokeys.empty()) {
            std::string values;
            for (const std::uint16_t v : geokeys)
                values += little(v);
            entries.push_back({34735, 3, static_cast<std::uint32_t>(geokeys.size()), values});
        }
        if (!metadata.empty())
            text(42112, metadata);
        if (!nodata.empty())
            text(42113, nodata);
        const std::string padded = data + std::string(data.size() % 2, '\0');
        const std::string mask_bits = packed_mask();
        std::string file = "II*" + std::string(1, '\0') +
                           little(static_cast<std::uint32_t>(8 + padded.size())) + padded;
        std::string directory = little(static_cast<std::uint16_t>(entries.size())), values;
        const std::size_t after = file.size() + 2 + 12 * entries.size() + 4;
        for (const Entry& entry : entries) {
            directory += little(entry.tag) + little(entry.type) + little(entry.count);
            if (entry.value.size() <= 4) {
                directory += entry.value + std::string(4 - entry.value.size(), '\0');
            } else {
                directory += little(static_cast<std::uint32_t>(after + values.size()));
                values += entry.value + std::string(entry.value.size() % 2, '\0');
            }
        }
        if (inner_mask.empty())
            return file + directory + little(std::uint32_t{0}) + values;
        const auto bits_at = static_cast<std::uint32_t>(after + values.size());
        const auto next = static_cast<std::uint32_t>(bits_at + mask_bits.size());
        return file + directory + little(next) + values + mask_bits +
               mask_directory(bits_at, mask_bits.size());
    }

private:
    [[nodiscard]] std::string packed_mask() const {
        std::string packed;
        for (std::uint32_t j = 0; j < height && !inner_mask.empty(); ++j)
            for (std::uint32_t i = 0; i < width; ++i) {
                if (i % 8 == 0)
                    packed += '\0';
                if (inner_mask[j * width + i] != 0)
                    packed.back() = static_cast<char>(packed.back() | (0x80 >> (i % 8)));
            }
        return packed + std::string(packed.size() % 2, '\0');
    }
    [[nodiscard]] std::string mask_directory(std::uint32_t at, std::size_t size) const {
        const std::vector<std::pair<std::uint16_t, std::uint32_t>> numbers = {
            {254, 4},      {256, width},
            {257, height}, {258, 1},
            {259, 1},      {262, 4},
            {273, at},     {277, 1},
            {278, height}, {279, static_cast<std::uint32_t>(size)}};
        std::string directory = little(static_cast<std::uint16_t>(numbers.size()));
        for (const auto& [tag, value] : numbers)
            directory +=
                little(tag) + little(std::uint16_t{4}) + little(std::uint32_t{1}) + little(value);
        return directory + little(std::uint32_t{0});
    }
};

inline const std::vector<std::uint16_t> kWgs84 = {1,    1, 0, 3, 1024, 0, 1, 2,
                                                  1025, 0, 1, 1, 2048, 0, 1, 4326};
inline const std::vector<std::uint16_t> kUtm32 = {1,    1, 0, 3, 1024, 0, 1, 1,
                                                  1025, 0, 1, 1, 3072, 0, 1, 32632};

/// Affine map of a GeoTIFF: x = a i + b j + c, y = d i + e j + f.
inline std::vector<double> affine(double a, double b, double c, double d, double e, double f) {
    return {a, b, 0, c, d, e, 0, f, 0, 0, 0, 0, 0, 0, 0, 1};
}

template<class T>
Tiff raster(std::uint32_t width, std::uint32_t height,
            const std::function<double(double, double)>& value) {
    Tiff tiff;
    tiff.width = width;
    tiff.height = height;
    tiff.bits = 8 * sizeof(T);
    tiff.format = std::is_floating_point_v<T> ? 3 : std::is_signed_v<T> ? 2 : 1;
    for (std::uint32_t j = 0; j < height; ++j)
        for (std::uint32_t i = 0; i < width; ++i)
            tiff.data += little(static_cast<T>(value(i, j)));
    return tiff;
}

inline std::uint32_t crc(const std::string& bytes) {
    std::uint32_t value = ~0u;
    for (const char c : bytes) {
        value ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            value = (value >> 1) ^ (value & 1 ? 0xEDB88320u : 0);
    }
    return ~value;
}

/// A PNG with stored (uncompressed) data; `rows` carry their filter bytes.
inline std::string png(std::uint32_t width, std::uint32_t height, int bits, int colour,
                       const std::string& rows, const std::string& palette = "") {
    const auto big = [](std::uint32_t v) {
        return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
    };
    const auto chunk = [&](const std::string& kind, const std::string& data) {
        return big(static_cast<std::uint32_t>(data.size())) + kind + data + big(crc(kind + data));
    };
    std::uint32_t a = 1, b = 0;
    for (const char c : rows)
        a = (a + static_cast<unsigned char>(c)) % 65521, b = (b + a) % 65521;
    const auto length = static_cast<std::uint16_t>(rows.size());
    const std::string stored = std::string("\x78\x01\x01", 3) + little(length) +
                               little(static_cast<std::uint16_t>(~length)) + rows +
                               big(b << 16 | a);
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR",
                 big(width) + big(height) + std::string{char(bits), char(colour), 0, 0, 0}) +
           (palette.empty() ? "" : chunk("PLTE", palette)) + chunk("IDAT", stored) +
           chunk("IEND", "");
}

} // namespace sward::assets::tests
