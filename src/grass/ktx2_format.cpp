// SPDX-License-Identifier: Apache-2.0
#include "grass/ktx2_format.h"

#include <array>
#include <bit>
#include <cstring>

namespace sward::grass {
namespace {

constexpr std::array<FormatTraits, 5> kFormats = {{
    {TexelFormat::kRgba8, "RGBA8 UNORM", 37, 1, 1, 4},    // VK_FORMAT_R8G8B8A8_UNORM
    {TexelFormat::kRgba32f, "RGBA32F", 109, 4, 1, 16},    // VK_FORMAT_R32G32B32A32_SFLOAT
    {TexelFormat::kRgba16f, "RGBA16F", 97, 2, 1, 8},      // VK_FORMAT_R16G16B16A16_SFLOAT
    {TexelFormat::kBc5, "BC5 UNORM", 141, 1, 4, 16},      // VK_FORMAT_BC5_UNORM_BLOCK
    {TexelFormat::kRgba8Srgb, "RGBA8 SRGB", 43, 1, 1, 4}, // VK_FORMAT_R8G8B8A8_SRGB
}};

// Khronos Data Format 1.3.
constexpr std::uint32_t kModelRgbsda = 1;
constexpr std::uint32_t kModelBc5 = 132;
constexpr std::uint32_t kPrimariesBt709 = 1;
constexpr std::uint32_t kTransferLinear = 1;
constexpr std::uint32_t kTransferSrgb = 2;
constexpr std::uint8_t kSampleFloat = 0x80;
constexpr std::uint8_t kSampleSigned = 0x40;
constexpr std::uint8_t kSampleLinear = 0x10; // whatever the transfer function says
constexpr std::uint8_t kChannelAlpha = 15;

struct Sample {
    std::uint16_t bit_offset;
    std::uint8_t last_bit; ///< bits - 1
    std::uint8_t channel;
    std::uint32_t position;
    std::uint32_t lower, upper; ///< what stands for 0 (or -1) and for 1
};
static_assert(sizeof(Sample) == 16);

std::vector<Sample> samples_of(TexelFormat format) {
    std::vector<Sample> samples;
    if (format == TexelFormat::kBc5) // one compressed channel is one sample of 64 bits
        return {{0, 63, 0, 0, 0, 0xFFFFFFFF}, {64, 63, 1, 0, 0, 0xFFFFFFFF}};
    const bool srgb = format == TexelFormat::kRgba8Srgb;
    const bool real = format != TexelFormat::kRgba8 && !srgb;
    const int bits = format == TexelFormat::kRgba32f ? 32 : real ? 16 : 8;
    for (int c = 0; c < 4; ++c) {
        const int channel = (c == 3 ? kChannelAlpha : c) |
                            (real ? kSampleFloat | kSampleSigned : 0) |
                            (srgb && c == 3 ? kSampleLinear : 0);
        samples.push_back({static_cast<std::uint16_t>(c * bits),
                           static_cast<std::uint8_t>(bits - 1), static_cast<std::uint8_t>(channel),
                           0, real ? std::bit_cast<std::uint32_t>(-1.0f) : 0,
                           real ? std::bit_cast<std::uint32_t>(1.0f) : 255});
    }
    return samples;
}

} // namespace

const FormatTraits& traits_of(TexelFormat format) {
    for (const FormatTraits& traits : kFormats)
        if (traits.format == format)
            return traits;
    return kFormats[0];
}

const FormatTraits* traits_of_vk(std::uint32_t vk_format) {
    for (const FormatTraits& traits : kFormats)
        if (traits.vk_format == vk_format)
            return &traits;
    return nullptr;
}

std::vector<std::byte> data_format_descriptor(TexelFormat format) {
    const FormatTraits& traits = traits_of(format);
    const std::vector<Sample> samples = samples_of(format);
    const auto block = static_cast<std::uint32_t>(24 + samples.size() * sizeof(Sample));
    const std::uint32_t model = format == TexelFormat::kBc5 ? kModelBc5 : kModelRgbsda;
    const std::uint32_t transfer =
        format == TexelFormat::kRgba8Srgb ? kTransferSrgb : kTransferLinear;
    const auto side = static_cast<std::uint32_t>(traits.block_side - 1);
    const std::array<std::uint32_t, 7> head = {
        4 + block,
        0,               // vendor Khronos, descriptor type basic
        2 | block << 16, // version 1.3
        model | kPrimariesBt709 << 8 | transfer << 16,
        side | side << 8,   // texel block, each side less 1
        traits.block_bytes, // of plane 0, unpacked
        0,                  // no other planes
    };
    std::vector<std::byte> dfd(sizeof head + samples.size() * sizeof(Sample));
    std::memcpy(dfd.data(), head.data(), sizeof head);
    std::memcpy(dfd.data() + sizeof head, samples.data(), samples.size() * sizeof(Sample));
    return dfd;
}

} // namespace sward::grass
