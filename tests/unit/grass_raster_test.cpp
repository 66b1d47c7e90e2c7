// SPDX-License-Identifier: Apache-2.0
// Layers and slices held to rays through the blades.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "grass_fixture.h"
#include "texgen/bake/far_level.h"
#include "texgen/patch/canopy.h"
#include "texgen/patch/placing.h"
#include "texgen/patch/rays.h"

namespace sward::texgen {
namespace {

using shared::BladeRecord;

double mean_coverage(const grass::TextureArray& array, int image, std::size_t mip) {
    const std::size_t bytes = array.mips[mip].size() / static_cast<std::size_t>(array.layers);
    double sum = 0;
    for (std::size_t t = 0; t < bytes; t += 4)
        sum += array.mips[mip][static_cast<std::size_t>(image) * bytes + t];
    return sum / 255.0 / (static_cast<double>(bytes) / 4);
}

/// Share of rays across a slab that meet a blade inside it: the exact coverage of the slab's
/// projection.
double slab_coverage(const BladeField& field, Family family, double low, double high, int rays) {
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        const auto n = static_cast<std::uint64_t>(i);
        const double a = base::hash_unit(3, 1, n) * field.side(), b = base::hash_unit(3, 2, n);
        std::optional<RayHit> hit;
        if (family == Family::kLayer)
            hit = field.cast({a, high, b * field.side()}, {0, -1, 0}, high - low);
        else if (family == Family::kSliceX)
            hit = field.cast({low, b * field.canopy(), a}, {1, 0, 0}, high - low);
        else
            hit = field.cast({a, b * field.canopy(), low}, {0, 0, 1}, high - low);
        hits += hit.has_value();
    }
    return static_cast<double>(hits) / rays;
}

TEST(Raster, CoverageOfEverySlabAgreesWithRays) {
    constexpr int kRays = 12000;
    const grass::GrassSet& set = small_set();
    const shared::GrassAppearance looks[] = {set.species.front().look};
    const BladeField field(std::span(set.blades).subspan(0, set.variant_begin[1]), looks,
                           set.side_m, set.canopy_m);
    double total_error = 0;
    int slabs = 0;
    for (const grass::FarLevel& level : set.levels) {
        const auto check = [&](Family family, const grass::TextureArray& array, int image,
                               double low, double high) {
            const double truth = slab_coverage(field, family, low, high, kRays);
            const double shown = mean_coverage(array, image, 0);
            const double noise = std::sqrt(truth * (1 - truth) / kRays);
            EXPECT_NEAR(shown, truth, 4 * noise + 0.003)
                << static_cast<int>(family) << " at " << low;
            total_error += shown - truth;
            ++slabs;
        };
        for (int i = 0; i < level.layer_count; ++i)
            check(Family::kLayer, level.layers, shared::layer_index(0, i, level.layer_count, 0),
                  level.layer_edges[static_cast<std::size_t>(i)],
                  level.layer_edges[static_cast<std::size_t>(i) + 1]);
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < level.slice_count; ++i)
                check(axis == shared::kAxisX ? Family::kSliceX : Family::kSliceZ, level.slices,
                      shared::slice_index(0, axis, i, level.slice_count, 0),
                      static_cast<double>(set.side_m) * i / level.slice_count,
                      static_cast<double>(set.side_m) * (i + 1) / level.slice_count);
    }
    EXPECT_LT(std::abs(total_error / slabs), 0.002); // no bias: nothing is dilated
}

TEST(Raster, ATexelNamesABladeThatStandsWhereItSays) {
    const grass::GrassSet& set = small_set();
    const grass::FarLevel& level = set.levels[0];
    const int size = level.layers.width;
    const double texel = static_cast<double>(set.side_m) / size,
                 step = 2.0 * set.offset_range_m / 255;
    int checked = 0;
    const auto check = [&](int variant, const std::uint8_t* id, const std::uint8_t* shape,
                           glm::dvec3 at) {
        if (id[0] == 0) {
            EXPECT_EQ(id[1] | id[2] | id[3] | shape[0] | shape[1] | shape[2] | shape[3], 0);
            return;
        }
        const shared::vec2 offset =
            shared::decode_offset(shared::vec2(shape[2], shape[3]) / 255.0f, set.offset_range_m);
        bool found = false;
        for (std::uint32_t b = set.variant_begin[variant];
             b < set.variant_begin[variant + 1] && !found; ++b) {
            const BladeRecord& blade = set.blades[b];
            found = static_cast<int>(blade.root.z * 256) == id[1] &&
                    static_cast<int>(blade.root.w * 256) == id[2] &&
                    std::abs(nearest_image(blade.root.x - at.x - offset.x, set.side_m)) < step &&
                    std::abs(nearest_image(blade.root.y - at.z - offset.y, set.side_m)) < step;
            if (!found)
                continue;
            shared::vec3 t = shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2),
                                                   shared::decode_along(id[3]));
            const shared::vec3 decoded =
                shared::decode_tangent(shared::vec2(shape[0], shape[1]) / 255.0f);
            EXPECT_GT(glm::dot(decoded, t.y < 0 ? -t : t), 0.98f);
            // The named point of the blade lies within the texel, give or take the blade's width
            // and the coding.
            const shared::vec3 p = shared::blade_curve(
                shared::vec3(blade.v1), shared::vec3(blade.v2), shared::decode_along(id[3]));
            if (at.y > 0) { // slice: compare heights
                EXPECT_NEAR(p.y, at.y, texel * 1.5 + 0.004);
            }
        }
        EXPECT_TRUE(found);
        ++checked;
    };
    for (std::uint64_t n = 0; n < 20000; ++n) {
        const int variant = static_cast<int>(n % 3);
        const auto x = static_cast<int>(base::hash64(1, 1, n) % static_cast<std::uint64_t>(size));
        const auto z = static_cast<int>(base::hash64(1, 2, n) % static_cast<std::uint64_t>(size));
        const int i =
            static_cast<int>(base::hash64(1, 3, n) % static_cast<std::uint64_t>(level.layer_count));
        const auto texel_at = [&](const grass::TextureArray& a, int image, int u, int v) {
            return a.mips[0].data() +
                   4 * ((static_cast<std::size_t>(image) * static_cast<std::size_t>(a.height) +
                         static_cast<std::size_t>(v)) *
                            static_cast<std::size_t>(size) +
                        static_cast<std::size_t>(u));
        };
        check(variant,
              texel_at(level.layers, shared::layer_index(variant, i, level.layer_count, 0), x, z),
              texel_at(level.layers, shared::layer_index(variant, i, level.layer_count, 1), x, z),
              {(x + 0.5) * texel, 0, (z + 0.5) * texel});
        const int row = z % level.slices.height;
        const double y = (row + 0.5) * set.canopy_m / level.slices.height,
                     middle = (i + 0.5) * set.side_m / level.slice_count;
        check(
            variant,
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisX, i, level.slice_count, 0), x, row),
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisX, i, level.slice_count, 1), x, row),
            {middle, y, (x + 0.5) * texel});
        check(
            variant,
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisZ, i, level.slice_count, 0), x, row),
            texel_at(level.slices,
                     shared::slice_index(variant, shared::kAxisZ, i, level.slice_count, 1), x, row),
            {(x + 0.5) * texel, y, middle});
    }
    EXPECT_GT(checked, 1000);
}

TEST(Raster, MipsKeepTheMeanCoverage) {
    for (const grass::FarLevel& level : small_set().levels)
        for (const grass::TextureArray* array : {&level.layers, &level.slices})
            for (std::size_t m = 1; m < array->mips.size() && (array->width >> m) >= 8; ++m) {
                double base = 0, mip = 0; // over all images: a nearly empty one has too few steps
                                          // of 1/255 to judge
                for (int image = 0; image < array->layers; image += shared::kPlanes) {
                    base += mean_coverage(*array, image, 0);
                    mip += mean_coverage(*array, image, m);
                }
                EXPECT_NEAR(mip / base, 1.0, 0.02) << array->width << " mip " << m;
            }
}

TEST(Raster, MipsKeepWhatAnAlphaTestSees) {
    // Texels at least half covered, over all images: as many at every mip as at mip 0 (B5).
    // Averaged coverage would fail: thin blades fall below a half at the first mip.
    for (const grass::FarLevel& level : small_set().levels)
        for (const grass::TextureArray* array : {&level.layers, &level.slices}) {
            const auto passing = [&](std::size_t m) {
                double passes = 0, texels = 0;
                const std::size_t plane =
                    array->mips[m].size() / static_cast<std::size_t>(array->layers);
                for (std::size_t image = 0; image < static_cast<std::size_t>(array->layers);
                     image += shared::kPlanes)
                    for (std::size_t t = 0; t < plane; t += 4, ++texels)
                        passes += array->mips[m][image * plane + t] >= 128 ? 1 : 0;
                return passes / texels;
            };
            for (std::size_t m = 1; m < array->mips.size() && (array->width >> m) >= 8; ++m)
                // A count of texels is whole in each image.
                EXPECT_NEAR(passing(m), passing(0),
                            0.02 * passing(0) + 0.5 * 4 * array->layers /
                                                    static_cast<double>(array->mips[m].size()))
                    << array->width << " mip " << m;
        }
}

TEST(Raster, AHeightMapShowsFromAboveWhatTheLayersShow) {
    for (const HeightMap coding : {HeightMap::kLinear, HeightMap::kTop}) {
        Preset preset = small_meadow();
        preset.height_map = coding;
        preset.variants = 1;
        preset.levels = 1;
        preset.far_rays = 8192;
        base::set_verbosity(base::Verbosity::kQuiet);
        const grass::GrassSet set =
            bake_set(preset, {.threads = 2, .volume = false, .preview = false});
        const grass::FarLevel& level = set.levels[0];
        ASSERT_EQ(level.layers.layers, shared::kPlanes); // one image
        const grass::FarRow& nadir = set.far.front();
        double shown = 0, height = 0;
        for (std::size_t t = 0; t < level.layers.mips[0].size() / 2; t += 4)
            if (level.layers.mips[0][t] > 0) {
                shown += 1;
                height += shared::decode_height(
                    static_cast<float>(level.layers.mips[0][t]) / 255.0f, set.height_coding);
            }
        EXPECT_NEAR(shown / (256 * 256), nadir.coverage, 0.03) << static_cast<int>(coding);
        EXPECT_NEAR(height / shown, nadir.height, 0.03) << static_cast<int>(coding);
    }
    for (const int coding : {shared::kHeightLinear, shared::kHeightTop})
        for (const float h : {0.0f, 0.3f, 0.9f, 1.0f})
            EXPECT_NEAR(shared::decode_height(shared::encode_height(h, coding), coding), h, 1e-6f);
    // Near the top, where shells are seen, a step of the top-weighted code is finer than a linear
    // one.
    EXPECT_LT(1 - shared::decode_height(254.0f / 255, shared::kHeightTop), 0.1f / 255);
}

TEST(Raster, LayersStandWhereTheyLieNearestToWhatIsSeen) {
    const Patch patch = small_patch();
    const double canopy = canopy_height(patch);
    const std::vector<double> seen = heights_seen(patch, canopy, 2);
    for (const int count : {1, 2, 5, 16}) {
        const Placing placed = place_layers(seen, canopy, count), even = even_layers(canopy, count);
        ASSERT_EQ(placed.heights.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(placed.edges.front(), 0);
        EXPECT_EQ(placed.edges.back(), static_cast<float>(canopy));
        for (std::size_t i = 0; i < placed.heights.size(); ++i) {
            EXPECT_LT(placed.edges[i], placed.heights[i]);
            EXPECT_LT(placed.heights[i], placed.edges[i + 1]);
        }
        EXPECT_LT(placing_error(seen, placed), 0.97 * placing_error(seen, even)) << count;
    }
}

} // namespace
} // namespace sward::texgen
