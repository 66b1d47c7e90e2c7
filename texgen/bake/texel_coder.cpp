// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/texel_coder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace sward::texgen {
namespace {

std::uint8_t unorm8(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

constexpr double kOpaque = 0.506; // above a half after any rounding
constexpr double kThin = 0.494;

} // namespace

double lot_of(std::int32_t blade) {
    const double turned = blade * (std::numbers::phi - 1);
    return turned - std::floor(turned);
}

double alpha_ratio(const TexelImage& image) {
    double sum = 0, half = 0;
    for (const Texel& texel : image.texels) {
        sum += texel.coverage;
        half += texel.coverage >= 0.5 ? 1 : 0;
    }
    return sum > 0 ? std::min(half / sum, 1.5) : 1;
}

void keep_alpha(TexelImage& image, double ratio) {
    struct Candidate {
        double margin;
        std::uint32_t texel;
    };
    std::vector<Candidate> candidates;
    double total = 0;
    for (std::uint32_t t = 0; t < image.texels.size(); ++t) {
        const Texel& texel = image.texels[t];
        if (texel.blade < 0 || texel.coverage <= 0)
            continue;
        total += texel.coverage;
        candidates.push_back({texel.coverage * ratio - lot_of(texel.blade), t});
    }
    // As many as are asked for: those whose coverage exceeds their blade's number, give or take a
    // few.
    const auto opaque =
        std::min(candidates.size(), static_cast<std::size_t>(std::llround(total * ratio)));
    std::ranges::nth_element(candidates, candidates.begin() + static_cast<std::ptrdiff_t>(opaque),
                             {}, [](const Candidate& c) { return std::tuple(-c.margin, c.texel); });
    double shown = 0, thin = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        float& coverage = image.texels[candidates[i].texel].coverage;
        const double chance = std::min(0.999, coverage * ratio);
        const double if_opaque = std::min(1.0, kOpaque + kThin * coverage);
        if (i < opaque) {
            coverage = static_cast<float>(if_opaque);
            shown += coverage;
        } else { // so that a texel of this coverage keeps it in the mean
            coverage = static_cast<float>(
                std::clamp((coverage - chance * if_opaque) / (1 - chance), 0.0, kThin));
            thin += coverage;
        }
    }
    const double scale = thin > 0 ? std::max(0.0, total - shown) / thin : 0;
    for (std::size_t i = opaque; i < candidates.size(); ++i) {
        float& coverage = image.texels[candidates[i].texel].coverage;
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
            const bool half = texel.coverage >= 0.5f; // no rounding across what an alpha test asks
            const int coverage =
                std::clamp(static_cast<int>(std::lround(steps)), half ? 128 : 0, half ? 255 : 127);
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
