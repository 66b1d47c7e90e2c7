// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/raster.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/hash.h"

namespace sward::texgen {

namespace {
constexpr std::uint64_t kOwnerStream = 0x0e2; // of the lots for a texel's owner
}
namespace {

constexpr int kSamples = 8; // a side: 64 bits a texel
// Sample columns shift from row to row, so that an upright edge meets 64 different places of a
// texel, not 8.
constexpr double kRowShift[kSamples] = {-0.4375, 0.0625, -0.1875, 0.3125,
                                        -0.3125, 0.1875, -0.0625, 0.4375};

int floor_mod(int a, int b) {
    const int r = a % b;
    return r < 0 ? r + b : r;
}

int floor_div(int a, int b) {
    return (a - floor_mod(a, b)) / b;
}

} // namespace

struct SlabRaster::Piece {
    Corner corner[8]; ///< u and v in samples
    int count = 0;
    double along0 = 0, along_u = 0, along_v = 0; ///< v of the blade as a plane over the image

    /// Keeps what lies on the positive side of sign * (s - at) (Sutherland-Hodgman, one plane).
    void clip(double at, double sign) {
        Corner kept[8];
        int n = 0;
        for (int i = 0; i < count; ++i) {
            const Corner& a = corner[i];
            const Corner& b = corner[(i + 1) % count];
            const double da = sign * (a.s - at), db = sign * (b.s - at);
            if (da >= 0)
                kept[n++] = a;
            if ((da >= 0) != (db >= 0)) {
                const double t = da / (da - db);
                kept[n++] = {at, a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
            }
        }
        std::copy_n(kept, n, corner);
        count = n;
    }
};

const std::vector<Texel>& SlabRaster::draw(const Slab& slab, std::span<const Outline> blades) {
    slab_ = slab;
    const auto texels =
        static_cast<std::size_t>(slab.width) * static_cast<std::size_t>(slab.height);
    texels_.assign(texels, {});
    all_.assign(texels, 0);
    mask_.assign(texels, 0);
    along_sum_.assign(texels, 0);
    total_.assign(texels, 0);
    const int axis = axes_of(slab.family).slab;
    const bool periodic = axis != 1;
    for (std::size_t b = 0; b < blades.size(); ++b) {
        const Outline& blade = blades[b];
        const int images = periodic && slab.wrap ? 1 : 0;
        for (int image = -images; image <= images; ++image) {
            const double shift = image * slab.side;
            if (blade.high[axis] + shift < slab.low || blade.low[axis] + shift > slab.high)
                continue;
            for (int i = 0; i < Outline::kSegments; ++i)
                segment(blade, i, shift);
        }
        settle(static_cast<std::int32_t>(b));
    }
    for (std::size_t t = 0; t < texels; ++t)
        texels_[t].coverage = static_cast<float>(std::popcount(all_[t])) / (kSamples * kSamples);
    return texels_;
}

void SlabRaster::segment(const Outline& blade, int i, double shift) {
    const Axes axes = axes_of(slab_.family);
    const double scale_u = kSamples / slab_.texel_u, scale_v = kSamples / slab_.texel_v;
    const auto corner = [&](int at, double sign) {
        const glm::dvec3 p = blade.centre[at] + sign * blade.half[at] * blade.across;
        return Corner{p[axes.slab] + shift, p[axes.u] * scale_u, p[axes.v] * scale_v};
    };
    Piece piece;
    piece.corner[0] = corner(i, -1);
    piece.corner[1] = corner(i, 1);
    piece.corner[2] = corner(i + 1, 1);
    piece.corner[3] = corner(i + 1, -1);
    piece.count = 4;
    // v is constant along the width direction, so it falls off across that direction's image.
    const double across_u = blade.across[axes.u] * scale_u,
                 across_v = blade.across[axes.v] * scale_v;
    const double from_u = blade.centre[i][axes.u] * scale_u,
                 from_v = blade.centre[i][axes.v] * scale_v;
    const double step = (blade.centre[i + 1][axes.v] * scale_v - from_v) * across_u -
                        (blade.centre[i + 1][axes.u] * scale_u - from_u) * across_v;
    const double rise =
        blade.v[static_cast<std::size_t>(i) + 1] - blade.v[static_cast<std::size_t>(i)];
    const double gain = std::abs(step) > 1e-9 ? rise / step : 0.0;
    piece.along_u = -across_v * gain;
    piece.along_v = across_u * gain;
    piece.along0 =
        blade.v[static_cast<std::size_t>(i)] - piece.along_u * from_u - piece.along_v * from_v;
    piece.clip(slab_.low, 1);
    piece.clip(slab_.high, -1);
    if (piece.count >= 3)
        fill(piece);
}

void SlabRaster::fill(const Piece& piece) {
    double low = piece.corner[0].v, high = low;
    for (int i = 1; i < piece.count; ++i) {
        low = std::min(low, piece.corner[i].v);
        high = std::max(high, piece.corner[i].v);
    }
    const int first_row = static_cast<int>(std::ceil(low - 0.5));
    const int last_row = static_cast<int>(std::ceil(high - 0.5)); // excluded
    for (int row = first_row; row < last_row; ++row) {
        const double y = row + 0.5;
        double left = 1e30, right = -1e30;
        for (int i = 0; i < piece.count; ++i) {
            const Corner& a = piece.corner[i];
            const Corner& b = piece.corner[(i + 1) % piece.count];
            if ((a.v <= y) == (b.v <= y))
                continue;
            const double u = a.u + (y - a.v) / (b.v - a.v) * (b.u - a.u);
            left = std::min(left, u);
            right = std::max(right, u);
        }
        const double offset = 0.5 + kRowShift[floor_mod(row, kSamples)];
        span(row, static_cast<int>(std::ceil(left - offset)),
             static_cast<int>(std::ceil(right - offset)), piece);
    }
}

void SlabRaster::span(int row, int first, int last, const Piece& piece) {
    int texel_row = floor_div(row, kSamples);
    if (!slab_.wrap) { // cut at the patch's edge
        first = std::max(first, 0);
        last = std::min(last, slab_.width * kSamples);
    }
    if (slab_.family == Family::kLayer && slab_.wrap)
        texel_row = floor_mod(texel_row, slab_.height);
    else if (texel_row < 0 || texel_row >= slab_.height)
        return;
    while (first < last) {
        const int column = floor_div(first, kSamples);
        const int begin = first - column * kSamples;
        const int end = std::min(last - column * kSamples, kSamples);
        const std::uint64_t bits = ((std::uint64_t{1} << (end - begin)) - 1)
                                   << begin << (floor_mod(row, kSamples) * kSamples);
        const auto t = static_cast<std::size_t>(texel_row) * static_cast<std::size_t>(slab_.width) +
                       static_cast<std::size_t>(floor_mod(column, slab_.width));
        if (mask_[t] == 0)
            touched_.push_back(static_cast<std::uint32_t>(t));
        const std::uint64_t fresh = bits & ~mask_[t];
        mask_[t] |= bits;
        const double along = piece.along0 +
                             piece.along_u * (column * kSamples + (begin + end) * 0.5) +
                             piece.along_v * (row + 0.5);
        along_sum_[t] += static_cast<float>(std::popcount(fresh) * std::clamp(along, 0.0, 1.0));
        first = column * kSamples + end;
    }
}

void SlabRaster::settle(std::int32_t blade) {
    for (const std::uint32_t t : touched_) {
        const int covered = std::popcount(mask_[t]);
        all_[t] |= mask_[t];
        total_[t] = static_cast<std::uint16_t>(total_[t] + covered);
        // By lot, weighted by area: the larger share would always win for the wide, dark lower
        // parts.
        if (base::hash_unit(kOwnerStream, t, static_cast<std::uint64_t>(blade)) * total_[t] <
            covered) {
            texels_[t].blade = blade;
            texels_[t].along = along_sum_[t] / static_cast<float>(covered);
        }
        mask_[t] = 0;
        along_sum_[t] = 0;
    }
    touched_.clear();
}

} // namespace sward::texgen
