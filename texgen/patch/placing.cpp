// SPDX-License-Identifier: Apache-2.0
#include "texgen/patch/placing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "texgen/patch/rays.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

constexpr std::array kViews = {75.0, 60.0, 45.0}; // where shells count beside the slices
constexpr int kRays = 8192;                       // a view
constexpr int kBins = 256;                        // of height, that edges may fall between

/// Heights in bins, with sums so that the cost of any slab is had at once.
class Histogram {
public:
    Histogram(std::span<const double> seen, double canopy_m) : canopy_m_(canopy_m) {
        std::array<double, kBins> weight;
        weight.fill(1e-3); // where nothing is seen, layers still spread evenly
        for (const double y : seen)
            weight[static_cast<std::size_t>(
                std::clamp(static_cast<int>(y / canopy_m * kBins), 0, kBins - 1))] += 1;
        for (std::size_t i = 0; i < kBins; ++i) {
            sum_[i + 1] = sum_[i] + weight[i];
            moment_[i + 1] = moment_[i] + weight[i] * middle(i);
        }
    }

    /// Bin in [a, b) that holds the weighted median.
    [[nodiscard]] std::size_t median(std::size_t a, std::size_t b) const {
        const double half = (sum_[a] + sum_[b]) / 2;
        const auto at = std::lower_bound(sum_.begin() + static_cast<std::ptrdiff_t>(a) + 1,
                                         sum_.begin() + static_cast<std::ptrdiff_t>(b), half);
        return static_cast<std::size_t>(at - sum_.begin()) - 1;
    }
    /// Sum of the distances from the median of the bins [a, b).
    [[nodiscard]] double cost(std::size_t a, std::size_t b) const {
        const std::size_t m = median(a, b);
        const double at = middle(m);
        return at * (sum_[m] - sum_[a]) - (moment_[m] - moment_[a]) + (moment_[b] - moment_[m]) -
               at * (sum_[b] - sum_[m]);
    }
    [[nodiscard]] double middle(std::size_t bin) const {
        return (static_cast<double>(bin) + 0.5) / kBins * canopy_m_;
    }
    [[nodiscard]] double edge(std::size_t bin) const {
        return static_cast<double>(bin) / kBins * canopy_m_;
    }

private:
    double canopy_m_;
    std::array<double, kBins + 1> sum_{};
    std::array<double, kBins + 1> moment_{};
};

/// Bins at which the best `count` slabs begin, and kBins at the end.
std::vector<std::size_t> best_edges(const Histogram& histogram, int count) {
    const auto slabs = static_cast<std::size_t>(count);
    std::vector<std::array<double, kBins + 1>> cost(slabs + 1);
    std::vector<std::array<std::size_t, kBins + 1>> from(slabs + 1);
    for (auto& row : cost)
        row.fill(1e300);
    cost[0][0] = 0;
    for (std::size_t n = 1; n <= slabs; ++n)
        for (std::size_t b = n; b <= kBins; ++b)
            for (std::size_t a = n - 1; a < b; ++a) {
                if (cost[n - 1][a] >= 1e300)
                    continue;
                const double c = cost[n - 1][a] + histogram.cost(a, b);
                if (c < cost[n][b]) {
                    cost[n][b] = c;
                    from[n][b] = a;
                }
            }
    std::vector<std::size_t> edges(slabs + 1);
    edges[slabs] = kBins;
    for (std::size_t n = slabs; n > 0; --n)
        edges[n - 1] = from[n][edges[n]];
    return edges;
}

} // namespace

std::vector<double> heights_seen(const Patch& patch, double canopy_m, int threads) {
    std::vector<BladeField> fields;
    for (int v = 0; v < patch.variants(); ++v)
        fields.emplace_back(patch.variant(v), patch.looks, patch.side_m, canopy_m);
    std::array<std::vector<double>, kViews.size()> met;
    parallel_for(kViews.size(), resolve_threads(threads), [&](std::size_t view, int) {
        for (int i = 0; i < kRays; ++i) {
            const BladeField& field = fields[static_cast<std::size_t>(i) * fields.size() / kRays];
            const SampleRay ray = sample_ray(i, kViews[view], field.side(), field.canopy());
            if (const auto hit = field.cast(ray.origin, ray.direction))
                met[view].push_back(hit->position.y);
        }
    });
    std::vector<double> seen;
    for (const std::vector<double>& some : met)
        seen.insert(seen.end(), some.begin(), some.end());
    std::ranges::sort(seen);
    return seen;
}

Placing place_layers(std::span<const double> seen, double canopy_m, int count) {
    const Histogram histogram(seen, canopy_m);
    const std::vector<std::size_t> bins = best_edges(histogram, count);
    Placing placing;
    for (std::size_t i = 0; i + 1 < bins.size(); ++i) {
        placing.edges.push_back(static_cast<float>(histogram.edge(bins[i])));
        placing.heights.push_back(
            static_cast<float>(histogram.middle(histogram.median(bins[i], bins[i + 1]))));
    }
    placing.edges.push_back(static_cast<float>(canopy_m));
    return placing;
}

Placing even_layers(double canopy_m, int count) {
    Placing placing;
    for (int i = 0; i <= count; ++i)
        placing.edges.push_back(static_cast<float>(canopy_m * i / count));
    for (int i = 0; i < count; ++i)
        placing.heights.push_back(static_cast<float>(canopy_m * (i + 0.5) / count));
    return placing;
}

double placing_error(std::span<const double> seen, const Placing& placing) {
    double sum = 0;
    for (const double y : seen) {
        const auto above = std::ranges::upper_bound(placing.edges, static_cast<float>(y));
        const auto layer = std::clamp<std::ptrdiff_t>(above - placing.edges.begin() - 1, 0,
                                                      std::ssize(placing.heights) - 1);
        sum += std::abs(y - placing.heights[static_cast<std::size_t>(layer)]);
    }
    return seen.empty() ? 0 : sum / static_cast<double>(seen.size());
}

} // namespace sward::texgen
