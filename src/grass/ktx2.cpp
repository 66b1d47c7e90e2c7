// SPDX-License-Identifier: Apache-2.0
#include "grass/ktx2.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <zstd.h>

#include "base/error.h"
#include "grass/ktx2_format.h"

namespace sward::grass {
namespace {

using base::ExitCode;
static_assert(std::endian::native == std::endian::little, "KTX2 is little-endian; so are we");

constexpr std::array<unsigned char, 12> kIdentifier = {0xAB, 'K',  'T',  'X',  ' ',  '2',
                                                       '0',  0xBB, '\r', '\n', 0x1A, '\n'};
constexpr std::uint32_t kSchemeNone = 0;
constexpr std::uint32_t kSchemeZstd = 2;
constexpr std::size_t kHeaderBytes = 80; // identifier, header and index
constexpr std::size_t kLevelBytes = 24;  // byteOffset, byteLength, uncompressedByteLength

struct Header {
    std::uint32_t format, type_size, width, height, depth, layers, faces, levels, scheme;
    std::uint32_t dfd_offset, dfd_bytes, kvd_offset, kvd_bytes;
};

struct Level {
    std::uint64_t offset, bytes, unpacked;
};

template<typename T> void put(std::vector<std::byte>& out, T value) {
    out.resize(out.size() + sizeof(T));
    std::memcpy(out.data() + out.size() - sizeof(T), &value, sizeof(T));
}

template<typename T> T get(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

std::vector<std::byte> key_values() {
    constexpr std::string_view kEntry{"KTXwriter\0Sward texgen\0", 23};
    std::vector<std::byte> kvd;
    put<std::uint32_t>(kvd, static_cast<std::uint32_t>(kEntry.size()));
    for (const char c : kEntry)
        kvd.push_back(static_cast<std::byte>(c));
    kvd.resize((kvd.size() + 3) / 4 * 4);
    return kvd;
}

std::vector<std::byte> pack(const std::vector<std::uint8_t>& raw, int compression) {
    if (compression == 0) {
        const auto* bytes = reinterpret_cast<const std::byte*>(raw.data());
        return {bytes, bytes + raw.size()};
    }
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                       ZSTD_freeCCtx);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag,
                           1); // a flipped byte must not become another picture
    // Not a vector: what zstd does not write takes no memory.
    const std::size_t bound = ZSTD_compressBound(raw.size());
    const auto packed = std::make_unique_for_overwrite<std::byte[]>(bound);
    const std::size_t size =
        ZSTD_compress2(context.get(), packed.get(), bound, raw.data(), raw.size());
    if (ZSTD_isError(size))
        throw base::Error(ExitCode::kFailure, fmt::format("zstd: {}", ZSTD_getErrorName(size)));
    return {packed.get(), packed.get() + size};
}

/// Reads a file of which nothing is believed.
class Decoder {
public:
    Decoder(std::span<const std::byte> bytes, const std::filesystem::path& name)
        : bytes_(bytes), name_(name) {}

    TextureArray run() {
        if (bytes_.size() < kHeaderBytes ||
            std::memcmp(bytes_.data(), kIdentifier.data(), kIdentifier.size()) != 0)
            refuse(ExitCode::kBadInput, "file",
                   fmt::format("{} bytes of something else", bytes_.size()), "KTX 2.0");
        std::memcpy(&header_, bytes_.data() + kIdentifier.size(), sizeof header_);
        check_format();
        check_size();
        TextureArray array{static_cast<int>(header_.width),
                           static_cast<int>(header_.height),
                           static_cast<int>(header_.layers),
                           {},
                           traits_->format,
                           header_.layers == 0};
        array.layers = std::max(1, array.layers);
        const std::vector<Level> levels = check_levels(array);
        for (const Level& level : levels)
            array.mips.push_back(unpack(level));
        if (array.format == TexelFormat::kRgba32f)
            check_finite(array);
        if (array.format == TexelFormat::kRgba16f)
            check_halves(array);
        return array;
    }

private:
    [[noreturn]] void refuse(ExitCode code, std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(code, name_, 0, what, found, expected);
    }

    void check_format() {
        traits_ = traits_of_vk(header_.format);
        if (!traits_)
            refuse(ExitCode::kBadInput, "format", std::to_string(header_.format),
                   "37 (RGBA8 UNORM), 43 (RGBA8 SRGB), 97 (RGBA16F), 109 (RGBA32F) or 141 (BC5 "
                   "UNORM)");
        if (header_.type_size != traits_->type_size)
            refuse(ExitCode::kBadInput, "type size", std::to_string(header_.type_size),
                   std::to_string(traits_->type_size));
        if (header_.scheme != kSchemeZstd && header_.scheme != kSchemeNone)
            refuse(ExitCode::kBadInput, "supercompression", std::to_string(header_.scheme),
                   "0 (none) or 2 (Zstandard)");
        if (header_.depth != 0 || header_.faces != 1)
            refuse(ExitCode::kBadInput, "shape",
                   fmt::format("depth {}, faces {}, layers {}", header_.depth, header_.faces,
                               header_.layers),
                   "a 2D array or texture");
        const std::vector<std::byte> dfd = data_format_descriptor(traits_->format);
        const std::uint64_t end = std::uint64_t{header_.dfd_offset} + header_.dfd_bytes;
        if (header_.dfd_bytes != dfd.size() || end > bytes_.size() ||
            std::memcmp(bytes_.data() + header_.dfd_offset, dfd.data(), dfd.size()) != 0)
            refuse(ExitCode::kBadInput, "data format descriptor", "another",
                   fmt::format("that of {}", traits_->name));
        if (std::uint64_t{header_.kvd_offset} + header_.kvd_bytes > bytes_.size())
            refuse(ExitCode::kBadInput, "key/value data", "an end beyond the file",
                   "an end inside");
        constexpr std::size_t kGlobalData = kHeaderBytes - 16;
        if (get<std::uint64_t>(bytes_, kGlobalData) != 0 ||
            get<std::uint64_t>(bytes_, kGlobalData + 8) != 0)
            refuse(ExitCode::kBadInput, "supercompression global data", "some", "none");
    }

    void check_size() const {
        if (header_.width == 0 || header_.height == 0)
            refuse(ExitCode::kBadInput, "size",
                   fmt::format("{} x {}", header_.width, header_.height), "at least 1 x 1");
        const std::uint32_t most_side = header_.layers == 0 ? kMaxPlainSide : kMaxSide;
        if (header_.width > most_side || header_.height > most_side ||
            header_.layers > kMaxArrayLayers)
            refuse(ExitCode::kOverLimit, "size",
                   fmt::format("{} x {} x {}", header_.width, header_.height, header_.layers),
                   fmt::format("at most {0} x {0} x {1}", most_side, kMaxArrayLayers));
        const auto most =
            static_cast<std::uint32_t>(std::bit_width(std::max(header_.width, header_.height)));
        if (header_.levels == 0 || header_.levels > most)
            refuse(ExitCode::kBadInput, "mips", std::to_string(header_.levels),
                   fmt::format("1 to {}", most));
        if (bytes_.size() < kHeaderBytes + header_.levels * kLevelBytes)
            refuse(ExitCode::kBadInput, "level index", "an end beyond the file", "an end inside");
    }

    std::vector<Level> check_levels(const TextureArray& array) const {
        std::vector<Level> levels;
        std::uint64_t total = 0;
        for (std::uint32_t m = 0; m < header_.levels; ++m) {
            const std::size_t at = kHeaderBytes + m * kLevelBytes;
            const Level level{get<std::uint64_t>(bytes_, at), get<std::uint64_t>(bytes_, at + 8),
                              get<std::uint64_t>(bytes_, at + 16)};
            const std::uint64_t expected = mip_bytes(array, static_cast<int>(m));
            if (level.unpacked != expected)
                refuse(ExitCode::kBadInput, fmt::format("mip {}", m),
                       fmt::format("{} bytes", level.unpacked), std::to_string(expected));
            if (level.offset > bytes_.size() || level.bytes > bytes_.size() - level.offset)
                refuse(ExitCode::kBadInput, fmt::format("mip {}", m), "an end beyond the file",
                       "an end inside");
            if (header_.scheme == kSchemeNone &&
                (level.bytes != expected || level.offset % traits_->block_bytes != 0))
                refuse(ExitCode::kBadInput, fmt::format("mip {}", m),
                       fmt::format("{} bytes at {}", level.bytes, level.offset),
                       fmt::format("{} at a multiple of {}", expected, traits_->block_bytes));
            total += expected;
            levels.push_back(level);
        }
        if (total > kMaxArrayBytes)
            refuse(ExitCode::kOverLimit, "array", fmt::format("{} bytes", total),
                   fmt::format("at most {}", kMaxArrayBytes));
        return levels;
    }

    std::vector<std::uint8_t> unpack(const Level& level) const {
        const std::byte* data = bytes_.data() + level.offset;
        if (header_.scheme == kSchemeNone) {
            const auto* first = reinterpret_cast<const std::uint8_t*>(data);
            return {first, first + level.bytes};
        }
        // The frame states its size: a bomb or a cut is refused before memory is taken.
        if (ZSTD_getFrameContentSize(data, level.bytes) != level.unpacked ||
            ZSTD_findFrameCompressedSize(data, level.bytes) != level.bytes)
            refuse(ExitCode::kBadInput, "zstd frame", "another size",
                   fmt::format("{} bytes from {}", level.unpacked, level.bytes));
        std::vector<std::uint8_t> raw(level.unpacked);
        const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), data, level.bytes);
        if (size != raw.size())
            refuse(ExitCode::kBadInput, "zstd frame",
                   ZSTD_isError(size) ? ZSTD_getErrorName(size) : "fewer bytes", "whole data");
        return raw;
    }

    void check_finite(const TextureArray& array) const {
        for (const std::vector<std::uint8_t>& mip : array.mips)
            for (std::size_t at = 0; at < mip.size(); at += sizeof(float)) {
                float value = 0;
                std::memcpy(&value, mip.data() + at, sizeof value);
                if (!std::isfinite(value))
                    refuse(ExitCode::kBadInput, "value", std::to_string(value), "a finite number");
            }
    }

    void check_halves(const TextureArray& array) const {
        for (const std::vector<std::uint8_t>& mip : array.mips)
            for (std::size_t at = 0; at + 1 < mip.size(); at += 2)
                if ((mip[at + 1] & 0x7C) == 0x7C) // all bits of the exponent
                    refuse(ExitCode::kBadInput, "value", "one that is no number",
                           "a finite number");
    }

    std::span<const std::byte> bytes_;
    const std::filesystem::path& name_;
    Header header_{};
    const FormatTraits* traits_ = nullptr;
};

} // namespace

std::uint64_t mip_bytes(const TextureArray& array, int mip) {
    const FormatTraits& traits = traits_of(array.format);
    const auto blocks = [&](int texels) {
        const int side = std::max(1, texels >> mip);
        return static_cast<std::uint64_t>((side + traits.block_side - 1) / traits.block_side);
    };
    return blocks(array.width) * blocks(array.height) * static_cast<std::uint64_t>(array.layers) *
           traits.block_bytes;
}

std::vector<std::byte> encode_ktx2(const TextureArray& array, int compression) {
    const FormatTraits& traits = traits_of(array.format);
    const std::vector<std::byte> dfd = data_format_descriptor(array.format);
    const std::vector<std::byte> kvd = key_values();
    const std::size_t count = array.mips.size();
    const std::size_t dfd_offset = kHeaderBytes + count * kLevelBytes;
    std::vector<std::byte> out;
    for (const unsigned char c : kIdentifier)
        out.push_back(static_cast<std::byte>(c));
    put(out, Header{traits.vk_format, traits.type_size, static_cast<std::uint32_t>(array.width),
                    static_cast<std::uint32_t>(array.height), 0,
                    array.plain ? 0 : static_cast<std::uint32_t>(array.layers), 1,
                    static_cast<std::uint32_t>(count), compression == 0 ? kSchemeNone : kSchemeZstd,
                    static_cast<std::uint32_t>(dfd_offset), static_cast<std::uint32_t>(dfd.size()),
                    static_cast<std::uint32_t>(dfd_offset + dfd.size()),
                    static_cast<std::uint32_t>(kvd.size())});
    put<std::uint64_t>(out, 0); // no supercompression global data
    put<std::uint64_t>(out, 0);
    // The index runs from the largest mip, the data from the smallest (a reader can show a small
    // one first).
    std::vector<std::vector<std::byte>> packed(count);
    std::vector<Level> levels(count);
    std::uint64_t offset = dfd_offset + dfd.size() + kvd.size();
    for (std::size_t m = count; m-- > 0;) {
        assert(array.mips[m].size() == mip_bytes(array, static_cast<int>(m)));
        packed[m] = pack(array.mips[m], compression);
        if (compression == 0)
            offset = (offset + traits.block_bytes - 1) / traits.block_bytes * traits.block_bytes;
        levels[m] = {offset, packed[m].size(), array.mips[m].size()};
        offset += packed[m].size();
    }
    for (const Level& level : levels)
        put(out, level);
    out.insert(out.end(), dfd.begin(), dfd.end());
    out.insert(out.end(), kvd.begin(), kvd.end());
    out.reserve(offset);
    for (std::size_t m = count; m-- > 0;) {
        out.resize(levels[m].offset); // up to the alignment
        out.insert(out.end(), packed[m].begin(), packed[m].end());
        packed[m] = {};
    }
    return out;
}

TextureArray decode_ktx2(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    return Decoder(bytes, name).run();
}

} // namespace sward::grass
