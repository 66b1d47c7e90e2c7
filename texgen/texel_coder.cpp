// SPDX-License-Identifier: Apache-2.0
#include "texgen/texel_coder.h"

#include <algorithm>
#include <cmath>

namespace sward::texgen {
namespace {

std::uint8_t unorm8(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

constexpr double kOpaque = 0.506; // above a half after any rounding
constexpr double kThin = 0.494;

/// The covered texels of one blade in an image.
struct Share {
    std::int32_t blade = -1;
    bool later = false; ///< not common to all variants
    std::vector<std::uint32_t> texels;
    double coverage = 0;
};

std::vector<Share> shares_of(const TexelImage& image, std::span<const char> common) {
    std::vector<Share> shares(common.size());
    for (std::uint32_t t = 0; t < image.texels.size(); ++t) {
        const Texel& texel = image.texels[t];
        if (texel.blade < 0 || texel.coverage <= 0)
            continue;
        Share& share = shares[static_cast<std::size_t>(texel.blade)];
        share.blade = texel.blade;
        share.texels.push_back(t);
        share.coverage += texel.coverage;
    }
    std::erase_if(shares, [](const Share& share) { return share.blade < 0; });
    for (Share& share : shares)
        share.later = !common[static_cast<std::size_t>(share.blade)];
    std::ranges::stable_sort(shares, {}, &Share::later);
    return shares;
}

} // namespace

double alpha_ratio(const TexelImage& image) {
    double sum = 0, half = 0;
    for (const Texel& texel : image.texels) {
        sum += texel.coverage;
        half += texel.coverage >= 0.5 ? 1 : 0;
    }
    return sum > 0 ? std::clamp(half / sum, 0.25, 1.5) : 1;
}

void keep_alpha(TexelImage& image, double ratio, std::span<const char> common) {
    double owed = 0; // texels to be opaque that no blade has given yet
    double total = 0, opaque = 0;
    std::vector<std::uint32_t> thin;
    for (const Share& share : shares_of(image, common)) {
        total += share.coverage;
        owed += ratio * share.coverage;
        const auto texels = static_cast<double>(share.texels.size());
        if (owed < texels / 2) {
            thin.insert(thin.end(), share.texels.begin(), share.texels.end());
            continue;
        }
        owed -= texels;
        for (const std::uint32_t t : share.texels) {
            float& coverage = image.texels[t].coverage;
            coverage = static_cast<float>(std::min(1.0, kOpaque + kThin * coverage));
            opaque += coverage;
        }
    }
    double rest = 0;
    for (const std::uint32_t t : thin)
        rest += image.texels[t].coverage;
    const double scale = rest > 0 ? std::max(0.0, total - opaque) / rest : 0;
    for (const std::uint32_t t : thin) {
        float& coverage = image.texels[t].coverage;
        coverage = static_cast<float>(std::min(kThin, coverage * scale));
    }
}

void Coder::code(const TexelImage& image, std::uint8_t* id, std::uint8_t* shape) const {
    std::size_t t = 0;
    double carry = 0; // of the rounding: the mean holds even where coverage is below one step
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column, ++t) {
            const Texel& texel = image.texels[t];
            if (texel.blade < 0)
                continue;
            const double steps = texel.coverage * 255.0 + carry;
            const int coverage = std::clamp(static_cast<int>(std::lround(steps)), 0, 255);
            carry = std::clamp(steps - coverage, -0.5, 0.5);
            if (coverage == 0)
                continue;
            const shared::BladeRecord& blade = blades_[static_cast<std::size_t>(texel.blade)];
            id[4 * t] = static_cast<std::uint8_t>(coverage);
            id[4 * t + 1] = static_cast<std::uint8_t>(blade.root.z * 256);
            id[4 * t + 2] = static_cast<std::uint8_t>(blade.root.w * 256);
            id[4 * t + 3] = static_cast<std::uint8_t>(
                shared::encode_place(static_cast<int>(species_of(blade)), texel.along));
            code_shape(blade, texel.along,
                       {(column + 0.5) / image.width, (row + 0.5) / image.height}, shape + 4 * t);
        }
}

void Coder::code_shape(const shared::BladeRecord& blade, float along, glm::dvec2 uv,
                       std::uint8_t* out) const {
    shared::vec3 tangent =
        shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2), along);
    if (tangent.y < 0)
        tangent = -tangent;
    out[0] = unorm8(tangent.x * 0.5 + 0.5);
    out[1] = unorm8(tangent.z * 0.5 + 0.5);
    const Axes axes = axes_of(slab_.family);
    glm::dvec3 at;
    at[axes.slab] = (slab_.low + slab_.high) / 2;
    at[axes.u] = uv.x * slab_.width * slab_.texel_u;
    at[axes.v] = uv.y * slab_.height * slab_.texel_v;
    const double side = slab_.side;
    out[2] = unorm8(nearest_image(blade.root.x - at.x, side) / frame_.offset_range_m * 0.5 + 0.5);
    out[3] = unorm8(nearest_image(blade.root.y - at.z, side) / frame_.offset_range_m * 0.5 + 0.5);
}

} // namespace sward::texgen
