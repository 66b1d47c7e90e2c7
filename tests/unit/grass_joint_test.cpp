// SPDX-License-Identifier: Apache-2.0
// Joints of tilings: any variant beside any other, in every layer and slice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grass_fixture.h"
#include "shared/grass_layout.h"

namespace sward::texgen {
namespace {

/// Images of one family as coverage, with the axis across the joint first.
struct Family {
    const grass::TextureArray& array;
    int images;      ///< a variant
    bool transposed; ///< the joint runs along u
    int (*index)(int variant, int image, int images);
};

int layer_of(int variant, int image, int images) {
    return shared::layer_index(variant, image, images, shared::kPlaneId);
}
int slice_of(int variant, int image, int images) {
    const int count = images / 2;
    return shared::slice_index(variant, image / count, image % count, count, shared::kPlaneId);
}

/// Sums of the coverage's steps across the joint of variants `left` and `right`, and across each
/// column of the interior.
struct Steps {
    double joint = 0;
    std::vector<double> interior;

    void add(const Family& family, int image, int left, int right) {
        const grass::TextureArray& a = family.array;
        const int width = family.transposed ? a.height : a.width,
                  height = family.transposed ? a.width : a.height;
        const auto coverage = [&](int variant, int u, int v) {
            const int x = family.transposed ? v : u, y = family.transposed ? u : v;
            const auto at = (static_cast<std::size_t>(family.index(variant, image, family.images)) *
                                 static_cast<std::size_t>(a.height) +
                             static_cast<std::size_t>(y)) *
                                static_cast<std::size_t>(a.width) +
                            static_cast<std::size_t>(x);
            return static_cast<int>(a.mips[0][4 * at]);
        };
        interior.resize(static_cast<std::size_t>(width) - 1);
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u + 1 < width; ++u)
                interior[static_cast<std::size_t>(u)] +=
                    std::abs(coverage(left, u, v) - coverage(left, u + 1, v));
            joint += std::abs(coverage(left, width - 1, v) - coverage(right, 0, v));
        }
    }
    [[nodiscard]] double median() const {
        std::vector<double> sorted = interior;
        std::ranges::nth_element(sorted, sorted.begin() + std::ssize(sorted) / 2);
        return sorted[sorted.size() / 2];
    }
    /// The interior's own scatter: a column of a sparse image holds few blades. Share of the
    /// columns as rough as the joint.
    [[nodiscard]] double as_rough() const {
        return static_cast<double>(
                   std::ranges::count_if(interior, [&](double s) { return s >= joint; })) /
               static_cast<double>(interior.size());
    }
};

Preset dense_meadow(bool wrap) {
    Preset preset = small_meadow();
    preset.density_per_m2 = 2500;
    preset.variants = 3;
    preset.levels = 2;
    preset.wrap = wrap;
    return preset;
}

/// The roughest joint of any pair over all images of a family, and the images whose own joint is
/// rougher than 1.2 medians and than all but a hundredth of the interior's columns.
struct Verdict {
    double roughest = 0;
    int images = 0;
    int rough_images = 0;
};

Verdict judge(const grass::GrassSet& set) {
    Verdict verdict;
    for (const grass::FarLevel& level : set.levels)
        for (const Family& family : {Family{level.layers, level.layer_count, false, layer_of},
                                     Family{level.layers, level.layer_count, true, layer_of},
                                     Family{level.slices, 2 * level.slice_count, false, slice_of}})
            for (int left = 0; left < set.variants; ++left)
                for (int right = 0; right < set.variants; ++right) {
                    Steps all;
                    for (int image = 0; image < family.images; ++image) {
                        Steps one;
                        one.add(family, image, left, right);
                        all.add(family, image, left, right);
                        ++verdict.images;
                        if (one.joint > 1.2 * one.median() && one.as_rough() < 0.01)
                            ++verdict.rough_images;
                    }
                    verdict.roughest = std::max(verdict.roughest, all.joint / all.median());
                }
    return verdict;
}

const BakeOptions kTexturesAlone{.threads = 2, .volume = false, .preview = false};

TEST(Joints, OfAnyVariantsAreNoRougherThanTheInterior) {
    base::set_verbosity(base::Verbosity::kQuiet);
    const Verdict good = judge(bake_set(dense_meadow(true), kTexturesAlone));
    EXPECT_LT(good.roughest, 1.2);
    EXPECT_LT(good.rough_images,
              0.04 *
                  good.images); // by chance: a hundredth of the columns, and those of sparse images

    const Verdict cut = judge(bake_set(dense_meadow(false), kTexturesAlone));
    EXPECT_GT(cut.roughest, 1.2); // a set with the wrap switched off fails
    RecordProperty("roughest", std::to_string(good.roughest));
    RecordProperty("cut", std::to_string(cut.roughest));
}

} // namespace
} // namespace sward::texgen
