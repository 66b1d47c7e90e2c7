// SPDX-License-Identifier: Apache-2.0
#include "grass/bc5.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "grass/ktx2.h"

namespace sward::grass {
namespace {

constexpr int kSide = 4;
constexpr std::size_t kBc5Bytes = 16;

/// Distinct values of a block and how many texels have each, in floats for vector units; those
/// beyond `size` count nothing.
struct Histogram {
    std::array<float, 16> value{};
    std::array<float, 16> count{};
    std::size_t size = 0;

    void add(int v) {
        const auto f = static_cast<float>(v);
        std::size_t i = 0;
        while (i < size && value[i] != f)
            ++i;
        value[i] = f;
        count[i] += 1;
        size = std::max(size, i + 1);
    }
};

struct Ends {
    int low = 0, high = 0;
    float error = 0; ///< sum of squares
};

/// Sum of squares of the values against `steps` + 1 even values from low to high. Four sums, so
/// that the order, and with it the bytes, do not depend on the compiler's vectors.
float error_of(const Histogram& h, int low, int high, int steps) {
    const auto base = static_cast<float>(low);
    const auto most = static_cast<float>(steps);
    const float step = static_cast<float>(high - low) / most;
    const float per_step = 1 / step;
    std::array<float, 4> sum{};
    for (std::size_t i = 0; i < h.size; i += 4)
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const float above = h.value[i + lane] - base;
            const float place = std::min(std::max(above * per_step + 0.5f, 0.0f), most);
            const float off = above - static_cast<float>(static_cast<int>(place)) * step;
            sum[lane] += h.count[i + lane] * (off * off);
        }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Descent over both ends from the extremes, in shrinking steps.
Ends fit(const Histogram& h, int steps) {
    const auto end = h.value.begin() + static_cast<std::ptrdiff_t>(h.size);
    const auto [least, most] = std::minmax_element(h.value.begin(), end);
    Ends best{static_cast<int>(*least), static_cast<int>(*most), 0};
    if (best.high - best.low <= steps) { // every whole value has a place in the palette
        best.low = std::min(best.low, 255 - steps);
        best.high = best.low + steps;
        return best;
    }
    best.error = error_of(h, best.low, best.high, steps);
    for (int move = std::max(1, (best.high - best.low) / steps); move > 0;) {
        const Ends from = best;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
                const int low = std::max(0, from.low + i * move);
                const int high = std::min(255, from.high + j * move);
                if ((i == 0 && j == 0) || high <= low)
                    continue;
                const float error = error_of(h, low, high, steps);
                if (error < best.error)
                    best = {low, high, error};
            }
        if (best.error == from.error)
            move /= 2;
    }
    return best;
}

Bc4Block pack(int end0, int end1, std::span<const std::uint8_t, 16> values, std::uint16_t used) {
    const std::array<double, 8> palette =
        bc4_palette(static_cast<std::uint8_t>(end0), static_cast<std::uint8_t>(end1));
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        if (!(used >> i & 1))
            continue;
        const double v = values[i] / 255.0;
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < 8; ++k)
            if (std::abs(palette[k] - v) < std::abs(palette[nearest] - v))
                nearest = k;
        bits |= static_cast<std::uint64_t>(nearest) << 3 * i;
    }
    Bc4Block block{static_cast<std::uint8_t>(end0), static_cast<std::uint8_t>(end1)};
    for (int i = 0; i < 6; ++i)
        block[static_cast<std::size_t>(2 + i)] = static_cast<std::uint8_t>(bits >> 8 * i);
    return block;
}

/// One image of a mip, of either format.
struct View {
    int width, height;
    std::size_t bytes; ///< an image

    View(const TextureArray& array, int mip)
        : width(std::max(1, array.width >> mip)), height(std::max(1, array.height >> mip)),
          bytes(mip_bytes(array, mip) / static_cast<std::size_t>(array.layers)) {}
};

/// Calls act(texel in the block, texel in the image) for the block's texels that lie in the image.
template<typename Act> void each_texel(const View& view, int bx, int by, const Act& act) {
    for (int y = by; y < std::min(by + kSide, view.height); ++y)
        for (int x = bx; x < std::min(bx + kSide, view.width); ++x)
            act(static_cast<std::size_t>((y - by) * kSide + x - bx),
                static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                    static_cast<std::size_t>(x));
}

void compress_block(const View& view, const std::uint8_t* id, std::uint8_t* shape,
                    std::array<std::uint8_t*, 2> out, int bx, int by) {
    std::uint16_t used = 0;
    std::array<std::array<std::uint8_t, 16>, 4> values{};
    each_texel(view, bx, by, [&](std::size_t i, std::size_t t) {
        used = static_cast<std::uint16_t>(used | (id[4 * t] > 0 ? 1u << i : 0u));
        for (std::size_t c = 0; c < 4; ++c)
            values[c][i] = shape[4 * t + c];
    });
    if (used == 0) { // most blocks: nothing stands there
        std::memset(out[0], 0, kBc5Bytes);
        std::memset(out[1], 0, kBc5Bytes);
        return;
    }
    for (std::size_t c = 0; c < 4; ++c) {
        const Bc4Block block = encode_bc4(values[c], used);
        std::memcpy(out[c / 2] + 8 * (c % 2), block.data(), block.size());
        values[c] = decode_bc4(block);
    }
    each_texel(view, bx, by, [&](std::size_t i, std::size_t t) {
        for (std::size_t c = 0; c < 4; ++c)
            shape[4 * t + c] = id[4 * t] > 0 ? values[c][i] : std::uint8_t{0};
    });
}

void decode_block(const View& view, const std::uint8_t* id, std::uint8_t* shape,
                  std::array<const std::uint8_t*, 2> in, int bx, int by) {
    for (std::size_t c = 0; c < 4; ++c) {
        Bc4Block block;
        std::memcpy(block.data(), in[c / 2] + 8 * (c % 2), block.size());
        const std::array<std::uint8_t, 16> values = decode_bc4(block);
        each_texel(view, bx, by, [&](std::size_t i, std::size_t t) {
            shape[4 * t + c] = id[4 * t] > 0 ? values[i] : std::uint8_t{0};
        });
    }
}

} // namespace

std::array<double, 8> bc4_palette(std::uint8_t end0, std::uint8_t end1) {
    const double a = end0 / 255.0, b = end1 / 255.0;
    std::array<double, 8> palette{a, b};
    const int steps = end0 > end1 ? 7 : 5;
    for (int k = 1; k < steps; ++k)
        palette[static_cast<std::size_t>(k + 1)] = ((steps - k) * a + k * b) / steps;
    if (steps == 5) {
        palette[6] = 0;
        palette[7] = 1;
    }
    return palette;
}

int bc4_index(const Bc4Block& block, int i) {
    std::uint64_t bits = 0;
    for (int b = 0; b < 6; ++b)
        bits |= static_cast<std::uint64_t>(block[static_cast<std::size_t>(2 + b)]) << 8 * b;
    return static_cast<int>(bits >> 3 * i & 7);
}

Bc4Block encode_bc4(std::span<const std::uint8_t, 16> values, std::uint16_t used) {
    Histogram all, inner; // inner: without 0 and 255, which the shorter palette has for nothing
    for (int i = 0; i < 16; ++i)
        if (used >> i & 1) {
            const int v = values[static_cast<std::size_t>(i)];
            all.add(v);
            if (v != 0 && v != 255)
                inner.add(v);
        }
    if (all.size <= 1) {
        const int only = all.size ? static_cast<int>(all.value[0]) : 0;
        return pack(only, only, values, used);
    }
    const Ends seven = fit(all, 7);
    if (inner.size < all.size && seven.error > 0) {
        const Ends five = inner.size ? fit(inner, 5) : Ends{};
        if (five.error < seven.error)
            return pack(five.low, five.high, values, used);
    }
    return pack(seven.high, seven.low, values, used);
}

std::array<std::uint8_t, 16> decode_bc4(const Bc4Block& block) {
    const std::array<double, 8> palette = bc4_palette(block[0], block[1]);
    std::array<std::uint8_t, 16> values;
    for (int i = 0; i < 16; ++i)
        values[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(
            std::lround(palette[static_cast<std::size_t>(bc4_index(block, i))] * 255));
    return values;
}

TextureArray empty_shapes(const TextureArray& planes) {
    TextureArray shapes{planes.width, planes.height, planes.layers, {}, TexelFormat::kBc5};
    for (std::size_t m = 0; m < planes.mips.size(); ++m)
        shapes.mips.emplace_back(mip_bytes(shapes, static_cast<int>(m)));
    return shapes;
}

void compress_shape(TextureArray& planes, int i, TextureArray& shapes) {
    const auto image = static_cast<std::size_t>(i);
    for (std::size_t m = 0; m < planes.mips.size(); ++m) {
        const View view(planes, static_cast<int>(m)), packed(shapes, static_cast<int>(m));
        std::uint8_t* id = planes.mips[m].data() + 2 * image * view.bytes;
        std::uint8_t* out = shapes.mips[m].data() + 2 * image * packed.bytes;
        std::size_t at = 0;
        for (int y = 0; y < view.height; y += kSide)
            for (int x = 0; x < view.width; x += kSide, at += kBc5Bytes)
                compress_block(view, id, id + view.bytes, {out + at, out + packed.bytes + at}, x,
                               y);
    }
}

TextureArray id_planes(const TextureArray& planes) {
    TextureArray ids{planes.width, planes.height, planes.layers / shared::kPlanes, {}};
    for (std::size_t m = 0; m < planes.mips.size(); ++m) {
        const View view(planes, static_cast<int>(m));
        std::vector<std::uint8_t>& mip = ids.mips.emplace_back();
        for (int i = 0; i < ids.layers; ++i) {
            const auto from =
                planes.mips[m].begin() + static_cast<std::ptrdiff_t>(2 * view.bytes) * i;
            mip.insert(mip.end(), from, from + static_cast<std::ptrdiff_t>(view.bytes));
        }
    }
    return ids;
}

TextureArray join_planes(const TextureArray& ids, const TextureArray& shapes) {
    TextureArray planes{ids.width, ids.height, ids.layers * shared::kPlanes, {}};
    for (std::size_t m = 0; m < ids.mips.size(); ++m) {
        planes.mips.emplace_back(mip_bytes(planes, static_cast<int>(m)));
        const View view(planes, static_cast<int>(m)), packed(shapes, static_cast<int>(m));
        for (std::size_t i = 0; i < static_cast<std::size_t>(ids.layers); ++i) {
            std::uint8_t* id = planes.mips[m].data() + 2 * i * view.bytes;
            std::memcpy(id, ids.mips[m].data() + i * view.bytes, view.bytes);
            const std::uint8_t* in = shapes.mips[m].data() + 2 * i * packed.bytes;
            std::size_t at = 0;
            for (int y = 0; y < view.height; y += kSide)
                for (int x = 0; x < view.width; x += kSide, at += kBc5Bytes)
                    decode_block(view, id, id + view.bytes, {in + at, in + packed.bytes + at}, x,
                                 y);
        }
    }
    return planes;
}

} // namespace sward::grass
