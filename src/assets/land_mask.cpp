// SPDX-License-Identifier: Apache-2.0
#include "assets/land_mask.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "assets/land_features.h"
#include "assets/limits.h"
#include "assets/mask_warp.h"
#include "base/error.h"
#include "base/log.h"
#include "shared/surface.h"

namespace sward::assets {
namespace {

using scene::LandClass;

constexpr double kTexelBytes = 12; // on the GPU, mips included
constexpr double kFinest_m = 0.5;  // nothing of a landcover is finer
constexpr double kPerPixel =
    4; // texels a side for one of the raster's pixels: places for a border to wander
constexpr int kSamples = 3; // a side of a texel on a border
constexpr int kMostSamples = 16;
constexpr double kWander = 0.6; // of a border, in pixels, times the noise

/// Sums over what a texel shows; linear.
struct Mix {
    double density = 0;
    std::array<double, scene::kLandBytes> land{};

    void add(const LandClass& look, double share) {
        density += share * look.density;
        const bool bears = look.density > 0;
        land[scene::kLandHeight] += bears ? share * look.height / scene::kLandMostHeight : 0;
        land[scene::kLandDryness] += share * (0.5 + 0.5 * look.dryness);
        land[scene::kLandBare] += bears ? 0 : share;
        switch (look.ground) {
        case scene::GroundKind::kSoil:
            break;
        case scene::GroundKind::kRock:
            land[scene::kLandRock] += share;
            break;
        case scene::GroundKind::kSand:
            land[scene::kLandSand] += share;
            break;
        case scene::GroundKind::kGravel:
            land[scene::kLandGravel] += share;
            break;
        case scene::GroundKind::kAsphalt:
            land[scene::kLandAsphalt] += share;
            break;
        case scene::GroundKind::kWater:
            land[scene::kLandWater] += share;
            break;
        }
    }
};

std::uint8_t byte(double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

/// The grid that a landcover is kept on.
struct Grid {
    MaskArea area;
    double pixel_m = kFinest_m; ///< of the raster
    glm::ivec2 size{1, 1};
    glm::dvec2 texel_m{1, 1};
};

/// The part of the terrain that areas and lines reach, with a rim.
MaskArea area_of(const std::vector<LandShapes>& shapes, const scene::TerrainSpec& spec,
                 glm::dvec2 terrain) {
    constexpr double kRim_m = 8;
    glm::dvec2 low(1e30), high(-1e30);
    double reach = kRim_m;
    const auto add = [&](const LandShapes::Ring& ring) {
        for (const glm::dvec2& point : ring)
            low = glm::min(low, point), high = glm::max(high, point);
    };
    for (std::size_t n = 0; n < shapes.size(); ++n) {
        reach = std::max(reach, kRim_m + spec.features[n].width_m);
        std::for_each(shapes[n].lines.begin(), shapes[n].lines.end(), add);
        for (const auto& rings : shapes[n].areas)
            std::for_each(rings.begin(), rings.end(), add);
    }
    low = glm::max(low - reach, -0.5 * terrain);
    high = glm::min(high + reach, 0.5 * terrain);
    if (!(low.x < high.x && low.y < high.y))
        throw base::input_error(base::ExitCode::kBadInput, spec.features.front().file, 0, "place",
                                "nothing on the terrain", "areas or lines that lie on it");
    return {low, high, false};
}

Grid choose_grid(const Channel* channel, const std::vector<LandShapes>& shapes,
                 const scene::TerrainSpec& spec, const scene::Heightfield& ground) {
    Grid grid;
    const glm::dvec2 whole = ground.extent_m();
    grid.area = {-0.5 * whole, 0.5 * whole, true};
    if (channel && channel->placement) {
        grid.area = mask_area(*channel, ground, spec.mask);
        const double pixel = finest_pixel_m(*channel, grid.area);
        grid.pixel_m =
            std::isfinite(pixel) ? pixel : std::min(ground.spacing_m.x, ground.spacing_m.y);
    } else if (channel) {
        grid.pixel_m = std::min(whole.x / channel->width, whole.y / channel->height);
    } else {
        grid.area = area_of(shapes, spec, whole);
    }
    const glm::dvec2 extent = grid.area.high - grid.area.low;
    const double most = spec.classes_mb * 1024 * 1024 / kTexelBytes;
    const double wanted =
        spec.features.empty()
            ? std::min(grid.pixel_m, std::max(grid.pixel_m / kPerPixel, kFinest_m))
            : std::min(grid.pixel_m, kFinest_m);
    const double texel = std::max({wanted, std::sqrt(extent.x * extent.y / most),
                                   std::max(extent.x, extent.y) / (kMostSide - 1)});
    grid.size = glm::max(glm::ivec2(glm::ceil(extent / texel - 1e-6)), glm::ivec2(1));
    grid.texel_m = extent / glm::dvec2(grid.size);
    return grid;
}

/// The classes of a raster at places of a grid.
class Classes {
public:
    Classes(const Channel& channel, const scene::TerrainSpec& spec, const Grid& grid)
        : channel_(channel), spec_(spec), grid_(grid), counts_(kClasses, 0) {
        if (channel.placement)
            posts_.emplace(*channel.placement, grid.area.low, grid.texel_m,
                           grid.size + 1); // grid points are corners
        const double ratio = std::max(grid.texel_m.x, grid.texel_m.y) / grid.pixel_m;
        fine_ = ratio < 1.5;
        samples_ = std::clamp(static_cast<int>(std::ceil(2 * ratio)), kSamples, kMostSamples);
    }

    [[nodiscard]] Mix at(int i, int j) {
        Mix mix;
        const glm::dvec2 middle = post(i + 0.5, j + 0.5);
        if (fine_ && even_about(middle)) {
            add(mix, middle, 1);
            return mix;
        }
        const glm::dvec2 aside =
            fine_ ? wander(grid_.area.low + (glm::dvec2(i, j) + 0.5) * grid_.texel_m)
                  : glm::dvec2(0);
        const double step = 1.0 / samples_;
        for (int n = 0; n < samples_ * samples_; ++n)
            add(mix, post(i + (n % samples_ + 0.5) * step, j + (n / samples_ + 0.5) * step) + aside,
                step * step);
        return mix;
    }

    /// Of the terrain's area.
    [[nodiscard]] std::map<int, double> shares(double terrain_m2) const {
        const double texel_m2 = grid_.texel_m.x * grid_.texel_m.y;
        std::map<int, double> shares;
        double known = 0;
        for (int value = 0; value < kClasses; ++value)
            if (const double share =
                    counts_[static_cast<std::size_t>(value)] * texel_m2 / terrain_m2;
                share > 0)
                shares[value] = share, known += share;
        if (1 - known > 1e-6)
            shares[-1] = 1 - known;
        return shares;
    }

private:
    glm::dvec2 post(double i, double j) const {
        if (posts_)
            return posts_->at(i, j);
        return glm::dvec2(i, j) / glm::dvec2(grid_.size) *
                   glm::dvec2(channel_.width, channel_.height) -
               0.5;
    }

    float value(glm::ivec2 pixel) const {
        pixel =
            glm::clamp(pixel, glm::ivec2(0), glm::ivec2(channel_.width - 1, channel_.height - 1));
        return channel_
            .values[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(channel_.width) +
                    static_cast<std::size_t>(pixel.x)];
    }

    /// Are the pixel at a post and its eight neighbours alike?
    bool even_about(glm::dvec2 post) const {
        if (std::isnan(post.x + post.y))
            return true;
        const glm::ivec2 pixel(glm::floor(post + 0.5));
        const float own = value(pixel);
        for (int n = 0; n < 9; ++n)
            if (value(pixel + glm::ivec2(n % 3 - 1, n / 3 - 1)) != own)
                return false;
        return true;
    }

    void add(Mix& mix, glm::dvec2 post, double share) {
        const bool within = post.x >= -0.5 && post.y >= -0.5 && post.x <= channel_.width - 0.5 &&
                            post.y <= channel_.height - 0.5; // NaN: no
        if (!within && channel_.placement) {
            mix.add(spec_.outside.value_or(LandClass{}), share);
            return;
        }
        const float found = value(glm::ivec2(glm::floor(post + 0.5)));
        if (std::isnan(found)) {
            mix.add(LandClass{}, share);
            return;
        }
        counts_[static_cast<std::size_t>(found)] += share;
        const auto look = spec_.classes.find(static_cast<int>(found));
        mix.add(look == spec_.classes.end() ? LandClass{} : look->second, share);
    }

    /// By how many pixels a place on a border is looked up aside.
    glm::dvec2 wander(glm::dvec2 place) const {
        glm::dvec2 sum(0);
        double weight = kWander;
        for (double wave = 4 * grid_.pixel_m; wave >= 2 * grid_.texel_m.x;
             wave *= 0.5, weight *= 0.6) {
            const glm::vec2 at(place / wave);
            sum += weight * glm::dvec2(shared::gradient_noise(at),
                                       shared::gradient_noise(at + glm::vec2(117.3f, -41.7f)));
        }
        return glm::clamp(sum, glm::dvec2(-0.9), glm::dvec2(0.9));
    }

    const Channel& channel_;
    const scene::TerrainSpec& spec_;
    const Grid& grid_;
    std::optional<PostGrid> posts_;
    std::vector<double> counts_; ///< texels by class
    bool fine_ = true;           ///< texels at most about as wide as pixels
    int samples_ = kSamples;
};

/// `mix` where the share `cover` of it lies under another class.
void burn(Mix& mix, const LandClass& look, double cover) {
    mix.density *= 1 - cover;
    for (double& part : mix.land)
        part *= 1 - cover;
    mix.add(look, cover);
}

void note_heights(const scene::TerrainSpec& spec, scene::DensityMask& mask) {
    const auto note = [&](const LandClass& look) {
        if (look.density > 0) {
            mask.highest = std::max(mask.highest, look.height);
            mask.heights = mask.heights || look.height != 1;
        }
    };
    for (const auto& [value, look] : spec.classes)
        note(look);
    for (const scene::LandFeature& feature : spec.features)
        note(feature.look);
    if (spec.outside)
        note(*spec.outside);
}

/// `shapes` are given away.
std::vector<FeatureRows> rows_of(const scene::TerrainSpec& spec, std::vector<LandShapes> shapes,
                                 const Grid& grid) {
    std::vector<FeatureRows> rows;
    const double texel = std::max(grid.texel_m.x, grid.texel_m.y);
    for (std::size_t n = 0; n < shapes.size(); ++n) {
        const scene::LandFeature& feature = spec.features[n];
        if (feature.width_m > 0 && feature.width_m < texel)
            base::log_warning(fmt::format("{}: lines of {} m on texels of {:.2f} m; drawn as wide "
                                          "as one (terrain.classes_mb makes them finer)",
                                          base::printable(feature.file.native(), 1024),
                                          feature.width_m, texel));
        const double width = feature.width_m > 0 ? std::max(feature.width_m, texel) : 0;
        rows.emplace_back(std::move(shapes[n]), width, grid.area.low, grid.texel_m);
    }
    return rows;
}

/// Rows of the mask, texel by texel.
void fill(const Grid& grid, const scene::TerrainSpec& spec,
          const std::vector<FeatureRows>& features, Classes* classes, scene::DensityMask& mask) {
    const LandClass under = spec.outside.value_or(LandClass(1)); // areas and lines alone
    std::vector<Mix> row(static_cast<std::size_t>(grid.size.x));
    std::vector<float> cover(row.size());
    for (int j = 0; j < grid.size.y; ++j) {
        for (int i = 0; i < grid.size.x; ++i) {
            Mix& mix = row[static_cast<std::size_t>(i)];
            mix = classes ? classes->at(i, j) : Mix{};
            if (!classes)
                mix.add(under, 1);
        }
        for (std::size_t n = 0; n < features.size(); ++n) {
            std::fill(cover.begin(), cover.end(), 0.0f);
            features[n].cover(j, cover);
            for (std::size_t i = 0; i < row.size(); ++i)
                if (cover[i] > 0)
                    burn(row[i], spec.features[n].look, std::min(double(cover[i]), 1.0));
        }
        for (const Mix& mix : row) {
            mask.density.push_back(static_cast<float>(mix.density));
            for (const double part : mix.land)
                mask.land.push_back(byte(part));
        }
    }
}

} // namespace

scene::DensityMask land_mask(const Channel* channel, const scene::TerrainSpec& spec,
                             const scene::Heightfield& ground) {
    std::vector<LandShapes> shapes;
    for (const scene::LandFeature& feature : spec.features)
        shapes.push_back(read_features(feature, ground));
    const Grid grid = choose_grid(channel, shapes, spec, ground);
    const std::vector<FeatureRows> features = rows_of(spec, std::move(shapes), grid);
    std::optional<Classes> classes;
    if (channel)
        classes.emplace(*channel, spec, grid);
    scene::DensityMask mask;
    mask.width = grid.size.x;
    mask.height = grid.size.y;
    mask.first_m = grid.area.low;
    mask.size_m = grid.area.high - grid.area.low;
    mask.bounded = channel && !grid.area.whole && !spec.outside;
    note_heights(spec, mask);
    const auto texels =
        static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
    mask.density.reserve(texels);
    mask.land.reserve(texels * scene::kLandBytes);
    fill(grid, spec, features, classes ? &*classes : nullptr, mask);
    if (!mask.bounded && !grid.area.whole) {
        Mix mix;
        mix.add(spec.outside.value_or(LandClass(1)), 1);
        mask.outside.emplace();
        (*mask.outside)[0] = byte(mix.density);
        std::transform(mix.land.begin(), mix.land.end(), mask.outside->begin() + 1, byte);
    }
    const glm::dvec2 extent = ground.extent_m();
    if (classes)
        mask.class_shares = classes->shares(extent.x * extent.y);
    return mask;
}

} // namespace sward::assets
