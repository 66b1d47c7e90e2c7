// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/albedo_mips.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "texgen/bake/footprint.h"

namespace sward::texgen {
namespace {

using shared::vec3;

constexpr float kPass = 128 / 255.0f,
                kFail = 127 / 255.0f; // bytes on both sides of an alpha test at 1/2
constexpr int kRings =
    2; // texels around a blade that take the mean of their neighbours; beyond, coarser mips

/// Next mip of an image whose texels are all times their alpha.
AlbedoImage halved(const AlbedoImage& image) {
    AlbedoImage mip{
        std::max(1, image.width / 2), std::max(1, image.height / 2), image.repeats_v, {}};
    const std::vector<Footprint> columns = footprints(image.width, mip.width),
                                 rows = footprints(image.height, mip.height);
    mip.texels.reserve(columns.size() * rows.size());
    for (const Footprint& row : rows)
        for (const Footprint& column : columns) {
            AlbedoTexel sum;
            for (int j = 0; j < row.count; ++j)
                for (int i = 0; i < column.count; ++i) {
                    const AlbedoTexel& t = image.at(column.index[i], row.index[j]);
                    const float share = row.share[j] * column.share[i];
                    sum.albedo += t.albedo * share;
                    sum.alpha += t.alpha * share;
                    sum.tangent += t.tangent * share;
                    sum.height += t.height * share;
                }
            mip.texels.push_back(sum);
        }
    return mip;
}

AlbedoTexel scaled(const AlbedoTexel& t, float by) {
    return {t.albedo * by, t.alpha, t.tangent * by, t.height * by};
}

/// Moves the sum of alphas by `change` within [low, high]: each by the same share of the room that
/// it has.
double spread(std::vector<float*>& alphas, double change, float low, float high) {
    const float bound = change > 0 ? high : low;
    double room = 0;
    for (const float* a : alphas)
        room += std::abs(bound - *a);
    const auto share = static_cast<float>(room > 0 ? std::min(1.0, std::abs(change) / room) : 0);
    for (float* a : alphas)
        *a += (bound - *a) * share;
    return change - std::copysign(share * room, change);
}

/// Makes `share` of the texels pass an alpha test, those of the most alpha, and keeps the mean.
void keep_coverage(AlbedoImage& image, double share) {
    std::vector<std::uint32_t> order(image.texels.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return image.texels[a].alpha > image.texels[b].alpha;
    });
    const auto pass =
        static_cast<std::size_t>(std::lround(share * static_cast<double>(order.size())));
    std::vector<float*> opaque, thin;
    double change = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        float& a = image.texels[order[i]].alpha;
        if (a <= 0) // nothing is there, and nothing comes
            continue;
        const float before = a;
        a = i < pass ? std::max(a, kPass) : std::min(a, kFail);
        change += before - a;
        (i < pass ? opaque : thin).push_back(&a);
    }
    if (change < 0)
        change = spread(thin, change, 0, kFail);
    change = spread(opaque, change, kPass, 1);
    if (change > 0)
        (void)spread(thin, change, 0, kFail);
}

/// Rounds alphas to bytes; what that loses is carried to the next texel, for thin blades are a few
/// of 255.
void round_alphas(AlbedoImage& image) {
    float carried = 0;
    for (AlbedoTexel& t : image.texels) {
        if (t.alpha <= 0)
            continue;
        const float wanted = t.alpha * 255 + carried;
        const bool passes = t.alpha >= kPass;
        const float code = std::clamp(std::round(wanted), passes ? kPass * 255 : 0.0f,
                                      passes ? 255.0f : kFail * 255);
        carried = wanted - code;
        t.alpha = code / 255;
    }
}

/// Gives the texels beside those that have a colour the mean of their neighbours'.
void grow(AlbedoImage& image, std::vector<char>& known) {
    const std::vector<char> before = known;
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(x);
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (before[index(x, y)])
                continue;
            AlbedoTexel sum;
            float count = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int nx = (x + dx + image.width) % image.width,
                              wrapped = (y + dy + image.height) % image.height;
                    if ((y + dy != wrapped && !image.repeats_v) || !before[index(nx, wrapped)])
                        continue;
                    const AlbedoTexel& t = image.at(nx, wrapped);
                    sum = {sum.albedo + t.albedo, 0, sum.tangent + t.tangent,
                           sum.height + t.height};
                    ++count;
                }
            if (count == 0)
                continue;
            sum = scaled(sum, 1 / count);
            image.at(x, y) = sum;
            known[index(x, y)] = 1;
        }
}

/// What texels without a blade show: their neighbours, else the next coarser mip (already filled),
/// else `empty`.
void fill(AlbedoImage& image, const AlbedoImage* coarser, const AlbedoTexel& empty) {
    std::vector<char> known(image.texels.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
        AlbedoTexel& t = image.texels[i];
        known[i] = t.alpha > 0;
        if (known[i])
            t = scaled(t, 1 / t.alpha);
    }
    for (int ring = 0; ring < kRings; ++ring)
        grow(image, known);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            AlbedoTexel& t = image.at(x, y);
            if (known[static_cast<std::size_t>(&t - image.texels.data())])
                continue;
            t = coarser ? coarser->at(std::min(x / 2, coarser->width - 1),
                                      std::min(y / 2, coarser->height - 1))
                        : empty;
            t.alpha = 0;
        }
}

} // namespace

AlbedoImage albedo_image(const TexelDecoder& decoder, const ImageSource& source, int rows) {
    AlbedoImage image{source.array->width, source.array->height + rows, !source.slice, {}};
    image.texels.resize(static_cast<std::size_t>(image.width) *
                        static_cast<std::size_t>(image.height));
    for (int y = rows; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const TexelValues v = decoder.texel(source, x, y - rows);
            image.at(x, y) = {v.albedo, static_cast<float>(v.coverage), v.tangent,
                              static_cast<float>(v.height)};
        }
    return image;
}

std::vector<AlbedoImage> albedo_mips(AlbedoImage image, int mips, const AlbedoTexel& empty) {
    std::size_t opaque = 0;
    for (AlbedoTexel& t : image.texels) {
        opaque += t.alpha >= kPass ? 1 : 0;
        t = scaled(t, t.alpha);
    }
    const double share = static_cast<double>(opaque) / static_cast<double>(image.texels.size());
    std::vector<AlbedoImage> chain{std::move(image)};
    while (chain.back().width > 1 || chain.back().height > 1)
        chain.push_back(halved(chain.back()));
    for (std::size_t m = chain.size(); m-- > 0;)
        fill(chain[m], m + 1 < chain.size() ? &chain[m + 1] : nullptr, empty);
    chain.resize(std::min(chain.size(), static_cast<std::size_t>(mips)));
    for (std::size_t m = 1; m < chain.size(); ++m) {
        keep_coverage(chain[m], share);
        round_alphas(chain[m]);
    }
    return chain;
}

} // namespace sward::texgen
