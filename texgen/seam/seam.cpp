// SPDX-License-Identifier: Apache-2.0
#include "texgen/seam/seam.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace sward::texgen {
namespace {

/// Columns that a path may use: [low, high).
struct Lane {
    int low = 0, high = 0;
    [[nodiscard]] int count() const { return high - low; }
};

/// Least-cost path down the rows within a lane, by dynamic programming. `start` >= 0 pins the first
/// row, and the path ends next to it.
std::vector<int> least_path(const std::vector<float>& cost, int width, int rows, Lane lane,
                            int start) {
    const auto n = static_cast<std::size_t>(lane.count());
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<double> sum(n), next(n);
    std::vector<std::int8_t> step(n * static_cast<std::size_t>(rows)); // to the row before
    const auto at = [&](int row, std::size_t i) {
        return cost[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + i +
                    static_cast<std::size_t>(lane.low)];
    };
    for (std::size_t i = 0; i < n; ++i)
        sum[i] = start >= 0 && static_cast<int>(i) + lane.low != start ? kNever : at(0, i);
    for (int row = 1; row < rows; ++row) {
        for (std::size_t i = 0; i < n; ++i) {
            double best = sum[i];
            std::int8_t from = 0;
            for (const int d : {-1, 1}) {
                const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) + d;
                if (j < 0 || j >= static_cast<std::ptrdiff_t>(n) ||
                    !(sum[static_cast<std::size_t>(j)] < best))
                    continue;
                best = sum[static_cast<std::size_t>(j)];
                from = static_cast<std::int8_t>(d);
            }
            next[i] = best + at(row, i);
            step[static_cast<std::size_t>(row) * n + i] = from;
        }
        sum.swap(next);
    }
    std::size_t end = 0;
    double least = kNever;
    for (std::size_t i = 0; i < n; ++i)
        if ((start < 0 || std::abs(static_cast<int>(i) + lane.low - start) <= 1) &&
            sum[i] < least) {
            least = sum[i];
            end = i;
        }
    std::vector<int> path(static_cast<std::size_t>(rows));
    for (int row = rows - 1; row >= 0; --row) {
        path[static_cast<std::size_t>(row)] = static_cast<int>(end) + lane.low;
        end = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(end) +
                                       step[static_cast<std::size_t>(row) * n + end]);
    }
    return path;
}

std::vector<int> boundary(const std::vector<float>& cost, int width, int rows, Lane lane,
                          bool closed) {
    std::vector<int> path = least_path(cost, width, rows, lane, -1);
    if (!closed)
        return path;
    // The free path's middle is the place that a closed one most wants to pass: from there the rows
    // are walked round.
    const int middle = rows / 2;
    std::vector<float> turned(cost.size());
    std::ranges::rotate_copy(cost, cost.begin() + static_cast<std::ptrdiff_t>(middle) * width,
                             turned.begin());
    path = least_path(turned, width, rows, lane, path[static_cast<std::size_t>(middle)]);
    std::ranges::rotate(path, path.end() - middle);
    return path;
}

/// What a column in which the larger wins costs, of the difference there: it holds more than either
/// side does, and a wide band of it would be seen as one.
constexpr float kLargerCost = 0.02f;

/// Costs of the two boundaries: of changing over at a column, and of the columns that this leaves
/// to the larger.
OverlapCost with_band(const OverlapCost& cost, int middle) {
    OverlapCost out{cost.width, cost.rows, cost.over, std::vector<float>(cost.under.size())};
    for (int row = 0; row < cost.rows; ++row) {
        const std::size_t first =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(cost.width);
        float band = 0;
        for (int x = middle - 1; x >= 0; --x) {
            const std::size_t i = first + static_cast<std::size_t>(x);
            band += kLargerCost * (cost.over[i] + cost.under[i]);
            out.over[i] += band;
        }
        band = 0;
        // The column before a change to `under` is the last that may show the cut-off side: its
        // cost stands there.
        for (int x = middle; x < cost.width; ++x) {
            const std::size_t i = first + static_cast<std::size_t>(x);
            out.under[i] = cost.under[i - 1] + band;
            band += kLargerCost * (cost.over[i] + cost.under[i]);
        }
    }
    return out;
}

} // namespace

std::string JointReport::words() const {
    return interior > 0 ? fmt::format("{:.2f} times the interior's", ratio())
                        : fmt::format("{:.3g}, the interior has none", joint);
}

Overlap find_overlap(const OverlapCost& cost, bool closed) {
    // Each has half of the overlap, so that they cannot cross. The outermost columns stay with
    // their side: the joint is then an interior pair of the picture, and so is the overlap's inner
    // end.
    const int middle = (cost.width + 1) / 2;
    Overlap out;
    out.width = cost.width;
    const OverlapCost whole = with_band(cost, middle);
    out.over = boundary(whole.over, cost.width, cost.rows, {1, middle}, closed);
    out.under = boundary(whole.under, cost.width, cost.rows, {middle, cost.width}, closed);
    return out;
}

int SeamCut::of(int side, const std::filesystem::path& what) const {
    if (side < 9)
        throw base::input_error(base::ExitCode::kBadInput, what, 0, "size",
                                fmt::format("{} texels a side", side),
                                "at least 9, to cut a third");
    const bool asked = texels > 0 || share != SeamCut{}.share;
    const int cut =
        texels > 0 ? texels : std::max(asked ? 0 : 3, static_cast<int>(std::lround(share * side)));
    if (cut < 3 || side - cut < 2 * cut)
        throw base::Error(
            base::ExitCode::kUsage,
            fmt::format("--cut: found {} of {}'s {} texels, expected 3 to {}: a third of the side",
                        cut, base::printable(what.string(), 300), side, side / 3));
    return cut;
}

} // namespace sward::texgen
