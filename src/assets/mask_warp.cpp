// SPDX-License-Identifier: Apache-2.0
#include "assets/mask_warp.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "assets/limits.h"
#include "base/error.h"

namespace sward::assets {
namespace {

constexpr double kMostTexels = 1 << 27;       // as fine as the mask's own pixels
constexpr double kMostSpreadTexels = 1 << 24; // only to place the borders of wide pixels
constexpr double kMostFineTexels = 1 << 22;   // that are finer than the posts
constexpr double kMostPerPixel = 64;          // texels for one of the mask, or of the posts
constexpr int kMostSamples = 16;              // a texel, along each side

using Rectangle = MaskArea;

bool covers(const Channel& channel, glm::dvec2 post) {
    return post.x >= -0.5 && post.y >= -0.5 && post.x <= channel.width - 0.5 &&
           post.y <= channel.height - 0.5; // NaN: no
}

struct Pixels {
    double finest_m =
        NAN; ///< the finer side of one, as most of the area has it; NaN where nothing is known
    double count = 0; ///< that lie in the area
};

/// The mask's pixels in an area, from places all over it: about a pole those of longitudes are of
/// every width down to none.
Pixels pixels_in(const Channel& channel, const Rectangle& area) {
    constexpr int kPlaces = 8; // a side
    constexpr double kStep_m = 1;
    const glm::dvec2 size = area.high - area.low;
    std::vector<double> finest;
    double per_m2 = 0;
    for (int n = 0; n < kPlaces * kPlaces; ++n) {
        const glm::dvec2 place =
            area.low + size * (glm::dvec2(n % kPlaces, n / kPlaces) + 0.5) / double(kPlaces);
        std::vector<glm::dvec2> cross = {
            {place.x, -place.y}, {place.x + kStep_m, -place.y}, {place.x, -place.y + kStep_m}};
        channel.placement->metres_to_posts(cross);
        const glm::dvec2 east = (cross[1] - cross[0]) / kStep_m,
                         north = (cross[2] - cross[0]) / kStep_m;
        const double most = std::max(glm::length(east), glm::length(north));
        if (!std::isfinite(most) || most <= 0 || most > channel.width)
            continue; // off the map, or across its seam
        finest.push_back(1 / most);
        per_m2 += std::abs(east.x * north.y - east.y * north.x);
    }
    if (finest.empty())
        return {};
    const auto middle = finest.begin() + static_cast<std::ptrdiff_t>(finest.size() / 2);
    std::nth_element(finest.begin(), middle, finest.end());
    return {*middle, per_m2 / double(finest.size()) * size.x * size.y};
}

struct Sampling {
    double texel_m = 1;
    int samples = 1;     ///< a side
    bool smooth = false; ///< densities of wide pixels
};

Sampling choose(const Channel& channel, bool by_class, const Rectangle& area, glm::dvec2 post_m) {
    const Pixels pixels = pixels_in(channel, area);
    const double post = std::min(post_m.x, post_m.y);
    const double pixel = std::isfinite(pixels.finest_m) ? pixels.finest_m : post;
    const glm::dvec2 size = area.high - area.low;
    const double known =
        kMostPerPixel *
        std::max(pixels.count,
                 size.x * size.y / (post * post)); // finer than that, nothing new is to be had
    const double most = std::min(known, pixel > post ? kMostSpreadTexels : kMostTexels);
    const double least =
        std::max(std::sqrt(size.x * size.y / most), std::max(size.x, size.y) / (kMostSide - 1));
    Sampling sampling;
    // Pixels about as wide as the posts, or wider: finer, so that their borders lie within a
    // fraction of a post.
    const auto fits = [&](double texel) {
        return size.x * size.y / (texel * texel) < kMostFineTexels && texel > least;
    };
    const double finest = pixel < 0.75 * post ? pixel
                          : fits(post / 4)    ? post / 4
                          : fits(post / 2)    ? post / 2
                                              : post;
    sampling.texel_m = std::max(std::min(pixel, finest), least);
    const double ratio = sampling.texel_m / pixel;
    const bool few = size.x * size.y / (sampling.texel_m * sampling.texel_m) < kMostSpreadTexels;
    sampling.smooth = !by_class && ratio < 0.75;
    sampling.samples = sampling.smooth
                           ? 1
                           : std::clamp(static_cast<int>(std::ceil((few ? 4 : 1) * ratio)),
                                        few ? 2 : 1, kMostSamples);
    return sampling;
}

/// Density between the middles of pixels; pixels without a value count as bare.
float interpolated(const Channel& channel, const MaskTable& table, glm::dvec2 post) {
    const glm::dvec2 at =
        glm::clamp(post, glm::dvec2(0), glm::dvec2(channel.width - 1, channel.height - 1));
    const glm::ivec2 base(glm::floor(at));
    const glm::ivec2 next = glm::min(base + 1, glm::ivec2(channel.width - 1, channel.height - 1));
    const glm::dvec2 f = at - glm::dvec2(base);
    const auto value = [&](int x, int y) {
        return double(table.density(
            channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(channel.width) +
                           static_cast<std::size_t>(x)]));
    };
    return static_cast<float>(glm::mix(glm::mix(value(base.x, base.y), value(next.x, base.y), f.x),
                                       glm::mix(value(base.x, next.y), value(next.x, next.y), f.x),
                                       f.y));
}

std::map<int, double> shares_of(const std::vector<std::uint64_t>& counts, double all) {
    std::map<int, double> shares;
    double known = 0;
    for (int value = 0; value < kClasses; ++value)
        if (const double share = double(counts[static_cast<std::size_t>(value)]) / all; share > 0)
            shares[value] = share, known += share;
    if (1 - known > 1e-9)
        shares[-1] = 1 - known;
    return shares;
}

} // namespace

MaskArea mask_area(const Channel& channel, const scene::Heightfield& ground,
                   const std::filesystem::path& path) {
    constexpr int kPoints = 256; // a side
    const glm::dvec2 half = 0.5 * ground.extent_m();
    std::vector<glm::dvec2> rim = outline(-half, half, kPoints);
    channel.placement->metres_to_posts(rim);
    const bool whole =
        std::all_of(rim.begin(), rim.end(), [&](glm::dvec2 p) { return covers(channel, p); });
    if (whole)
        return {-half, half, true};
    std::vector<glm::dvec2> border =
        outline({-0.5, -0.5}, {channel.width - 0.5, channel.height - 0.5}, kPoints);
    channel.placement->posts_to_metres(border);
    glm::dvec2 low(1e30), high(-1e30);
    for (const glm::dvec2& p : border) {
        if (!std::isfinite(p.x + p.y))
            return {-half, half, false}; // it goes around the Earth, or past its edge
        low = glm::min(low, glm::dvec2(p.x, -p.y));
        high = glm::max(high, glm::dvec2(p.x, -p.y));
    }
    const glm::dvec2 middle = 0.5 * (low + high), size = high - low;
    const bool any_inside =
        std::any_of(rim.begin(), rim.end(), [&](glm::dvec2 p) { return covers(channel, p); });
    low = glm::max(low, -half);
    high = glm::min(high, half);
    if (any_inside && !(low.x < high.x && low.y < high.y))
        return {-half, half, false}; // its outline is no outline here: it surrounds a pole
    if (!(low.x < high.x && low.y < high.y))
        throw base::input_error(
            base::ExitCode::kBadInput, path, 0, "place of the mask",
            fmt::format("{:.1f} x {:.1f} km, {:.1f} km from the terrain's middle", size.x / 1000,
                        size.y / 1000, glm::length(middle) / 1000),
            "one that covers some of the terrain");
    return {low, high, false};
}

double finest_pixel_m(const Channel& channel, const MaskArea& area) {
    return pixels_in(channel, area).finest_m;
}

MaskTable::MaskTable(const std::map<int, scene::LandClass>& classes) {
    if (classes.empty())
        return;
    densities_.assign(kClasses, 0.0f);
    for (const auto& [value, look] : classes)
        densities_[static_cast<std::size_t>(value)] = static_cast<float>(look.density);
}

float MaskTable::density(float value) const {
    if (std::isnan(value))
        return 0;
    return by_class() ? densities_[static_cast<std::size_t>(value)] : value;
}

scene::DensityMask spread_mask(Channel channel, const MaskTable& table) {
    scene::DensityMask mask;
    mask.width = channel.width;
    mask.height = channel.height;
    std::vector<std::uint64_t> counts(table.by_class() ? kClasses : 0);
    for (float& value : channel.values) {
        if (table.by_class() && !std::isnan(value))
            ++counts[static_cast<std::size_t>(value)];
        value = table.density(value);
    }
    if (table.by_class())
        mask.class_shares = shares_of(counts, double(channel.values.size()));
    mask.density = std::move(channel.values);
    return mask;
}

scene::DensityMask warp_mask(const Channel& channel, const MaskTable& table,
                             const scene::Heightfield& ground, const std::filesystem::path& path) {
    const Rectangle area = mask_area(channel, ground, path);
    const Sampling sampling = choose(channel, table.by_class(), area, ground.spacing_m);
    scene::DensityMask mask;
    mask.first_m = area.low;
    mask.size_m = area.high - area.low;
    mask.bounded = !area.whole;
    const glm::ivec2 size =
        glm::max(glm::ivec2(glm::ceil(mask.size_m / sampling.texel_m - 1e-6)), glm::ivec2(1));
    mask.width = size.x;
    mask.height = size.y;
    const glm::dvec2 texel = mask.size_m / glm::dvec2(size);
    const PostGrid posts(*channel.placement, area.low, texel,
                         size + 1); // grid points are the texels' corners
    mask.density.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    std::vector<std::uint64_t> counts(table.by_class() ? kClasses : 0);
    const double step = 1.0 / sampling.samples;
    for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i) {
            float sum = 0;
            for (int n = 0; n < sampling.samples * sampling.samples; ++n) {
                const glm::dvec2 post = posts.at(i + (n % sampling.samples + 0.5) * step,
                                                 j + (n / sampling.samples + 0.5) * step);
                if (!covers(channel, post))
                    continue;
                if (sampling.smooth) {
                    sum += interpolated(channel, table, post);
                    continue;
                }
                const glm::ivec2 pixel =
                    glm::clamp(glm::ivec2(glm::floor(post + 0.5)), glm::ivec2(0),
                               glm::ivec2(channel.width - 1, channel.height - 1));
                const float value = channel.values[static_cast<std::size_t>(pixel.y) *
                                                       static_cast<std::size_t>(channel.width) +
                                                   static_cast<std::size_t>(pixel.x)];
                sum += table.density(value);
                if (table.by_class() && !std::isnan(value))
                    ++counts[static_cast<std::size_t>(value)];
            }
            mask.density.push_back(sum * static_cast<float>(step * step));
        }
    if (table.by_class()) {
        const glm::dvec2 extent = ground.extent_m();
        const double all = double(mask.density.size()) * sampling.samples * sampling.samples *
                           (extent.x * extent.y) / (mask.size_m.x * mask.size_m.y);
        mask.class_shares = shares_of(counts, all);
    }
    return mask;
}

} // namespace sward::assets
