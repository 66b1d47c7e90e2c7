// SPDX-License-Identifier: Apache-2.0
// G2 on a stack of pictures.
#include "texgen/seam/seam_images.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/log.h"

namespace sward::texgen {
namespace {

constexpr std::size_t kSoonValues = std::size_t{1} << 24; // fewer are moved within a second

using assets::LayerImage;

/// Reads and writes along one axis of a picture: u across the joint, v along it.
struct View {
    const LayerImage& image;
    bool vertical; ///< u runs along y

    [[nodiscard]] int across() const { return vertical ? image.height : image.width; }
    [[nodiscard]] int along() const { return vertical ? image.width : image.height; }
    [[nodiscard]] std::size_t at(int u, int v) const {
        return (static_cast<std::size_t>(vertical ? u : v) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(vertical ? v : u)) *
               static_cast<std::size_t>(image.channels);
    }
    [[nodiscard]] double difference(std::size_t a, std::size_t b) const {
        double sum = 0;
        for (int c = 0; c < image.channels; ++c)
            sum += std::abs(static_cast<double>(image.values[a + static_cast<std::size_t>(c)]) -
                            static_cast<double>(image.values[b + static_cast<std::size_t>(c)]));
        return sum;
    }
    /// What decides between two texels.
    [[nodiscard]] float key(std::size_t i) const {
        if (const int alpha = image.alpha(); alpha >= 0)
            return image.values[i + static_cast<std::size_t>(alpha)];
        const float* p = &image.values[i];
        return image.channels == 3 ? 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] : p[0];
    }
};

/// Mean difference of column u and the next, round the joint, for every u.
std::vector<double> gradients(const View& view) {
    std::vector<double> out(static_cast<std::size_t>(view.across()));
    for (int u = 0; u < view.across(); ++u)
        for (int v = 0; v < view.along(); ++v)
            out[static_cast<std::size_t>(u)] +=
                view.difference(view.at(u, v), view.at((u + 1) % view.across(), v)) / view.along();
    return out;
}

OverlapCost cost_of(const LayerStack& stack, bool vertical, int cut) {
    const View first{stack.images.front(), vertical};
    OverlapCost cost{cut, first.along(), {}, {}};
    cost.over.resize(static_cast<std::size_t>(cut) * static_cast<std::size_t>(cost.rows));
    cost.under = cost.over;
    const int kept = first.across() - cut;
    for (const LayerImage& image : stack.images) {
        const View view{image, vertical};
        std::size_t i = 0;
        for (int v = 0; v < cost.rows; ++v)
            for (int u = 0; u < cut; ++u, ++i) {
                const std::size_t under = view.at(u, v), over = view.at(u + kept, v);
                (view.key(under) > view.key(over) ? cost.over : cost.under)[i] +=
                    static_cast<float>(view.difference(under, over));
            }
    }
    return cost;
}

LayerImage overlay(const LayerImage& image, const Overlap& overlap, bool vertical) {
    const View from{image, vertical};
    LayerImage out = image;
    const int kept = from.across() - overlap.width;
    (vertical ? out.height : out.width) = kept;
    const auto channels = static_cast<std::size_t>(image.channels);
    out.values.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) *
                      channels);
    const View to{out, vertical};
    for (int v = 0; v < from.along(); ++v)
        for (int u = 0; u < kept; ++u) {
            std::size_t source = from.at(u, v);
            if (u < overlap.width) {
                const std::size_t over = from.at(u + kept, v);
                const Overlap::Take take = overlap.at(u, v);
                if (take == Overlap::Take::kOver ||
                    (take == Overlap::Take::kLarger && from.key(over) >= from.key(source)))
                    source = over;
            }
            std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(source), channels,
                        out.values.begin() + static_cast<std::ptrdiff_t>(to.at(u, v)));
        }
    return out;
}

LayerStack along_axis(const LayerStack& stack, bool vertical, int cut, base::Progress& progress) {
    // Rows of the second axis are a circle by then.
    const Overlap overlap = find_overlap(cost_of(stack, vertical, cut), vertical);
    LayerStack out{stack.files, {}};
    for (const LayerImage& image : stack.images) {
        out.images.push_back(overlay(image, overlap, vertical));
        progress.advance();
    }
    return out;
}

} // namespace

JointReport measure_stack(const LayerStack& stack) {
    JointReport worst;
    for (const bool vertical : {false, true}) {
        std::vector<double> all;
        for (const LayerImage& image : stack.images) {
            const std::vector<double> own = gradients({image, vertical});
            all.resize(own.size());
            for (std::size_t i = 0; i < own.size(); ++i)
                all[i] += own[i];
        }
        const double joint = all.back();
        all.pop_back();
        if (all.empty())
            continue;
        const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
        std::ranges::nth_element(all, middle);
        const JointReport own{joint, *middle};
        if (vertical == false || own.ratio() > worst.ratio())
            worst = own;
    }
    return worst;
}

LayerStack seam_stack(const LayerStack& stack, const SeamCut& cut) {
    const LayerImage& first = stack.images.front();
    const std::filesystem::path& name = stack.files.front();
    const int across = cut.of(first.width, name), down = cut.of(first.height, name);
    const bool soon = first.values.size() * stack.images.size() < kSoonValues;
    base::Progress progress("laying borders over", soon ? 0 : 2 * stack.images.size());
    return along_axis(along_axis(stack, false, across, progress), true, down, progress);
}

} // namespace sward::texgen
