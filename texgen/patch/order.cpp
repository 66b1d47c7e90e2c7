// SPDX-License-Identifier: Apache-2.0
// Ranks as progressive blue noise: the next point is always the one in the emptiest place, measured
// against how many points there are to place (tufts keep their share at every prefix), by a kernel
// that narrows as the prefix grows.
#include <algorithm>
#include <cmath>
#include <queue>

#include "base/hash.h"
#include "texgen/patch/patch.h"

namespace sward::texgen {
namespace {

using shared::vec2;

constexpr double kReachSpacings = 1.9; // kernel radius in mean spacings of the stage's last prefix
constexpr double kMaxNeighbours =
    512; // bound on the kernel's points, so that early stages stay cheap

/// Points by cells of a toroidal grid.
class Neighbours {
public:
    Neighbours(std::span<const vec2> points, double side, double radius)
        : points_(points), side_(side), radius_(radius),
          cells_(std::clamp(static_cast<int>(kReach * side / radius), 1, 256)),
          buckets_(cells_ * cells_) {
        for (std::uint32_t i = 0; i < points.size(); ++i)
            buckets_[cell(points[i].x) + cells_ * cell(points[i].y)].push_back(i);
    }

    /// visit(j, kernel) for every point within the radius of point i.
    template<typename Visit> void around(std::uint32_t i, const Visit& visit) const {
        const int cx = cell(points_[i].x);
        const int cz = cell(points_[i].y);
        if (cells_ < 2 * kReach + 1) { // the rings of cells would visit some twice
            for (const auto& bucket : buckets_)
                visit_bucket(bucket, i, visit);
            return;
        }
        for (int dz = -kReach; dz <= kReach; ++dz)
            for (int dx = -kReach; dx <= kReach; ++dx)
                visit_bucket(
                    buckets_[(cx + dx + cells_) % cells_ + cells_ * ((cz + dz + cells_) % cells_)],
                    i, visit);
    }

private:
    static constexpr int kReach = 2; ///< cells a radius

    int cell(float v) const {
        return std::clamp(static_cast<int>(v / side_ * cells_), 0, cells_ - 1);
    }

    template<typename Visit>
    void visit_bucket(const std::vector<std::uint32_t>& bucket, std::uint32_t i,
                      const Visit& visit) const {
        for (const std::uint32_t j : bucket) {
            const double x = wrap(points_[j].x - points_[i].x);
            const double z = wrap(points_[j].y - points_[i].y);
            const double q = 1 - (x * x + z * z) / (radius_ * radius_);
            if (q > 0)
                visit(j, q * q * q);
        }
    }
    double wrap(double d) const {
        return d > side_ / 2 ? d - side_ : d < -side_ / 2 ? d + side_ : d;
    }

    std::span<const vec2> points_;
    double side_;
    double radius_;
    int cells_;
    std::vector<std::vector<std::uint32_t>> buckets_;
};

struct Candidate {
    double fill;
    std::uint64_t tie;
    std::uint32_t point;
    bool operator<(const Candidate& o) const {
        return fill != o.fill ? fill > o.fill : tie > o.tie;
    }
};

class Order {
public:
    Order(std::span<const vec2> points, double side, std::span<const std::int32_t> fixed,
          std::uint64_t seed)
        : points_(points), side_(side), fixed_(fixed), seed_(seed), placed_(points.size()),
          bound_(points.size()) {
        for (const std::int32_t f : fixed)
            if (f >= 0)
                bound_[static_cast<std::size_t>(f)] = true;
    }

    std::vector<std::uint32_t> run() {
        for (std::size_t end = 1; order_.size() < points_.size(); end *= 2)
            stage(std::min(end, points_.size()));
        return std::move(order_);
    }

private:
    void stage(std::size_t end) {
        const auto count = static_cast<double>(points_.size());
        const double spacing = side_ / std::sqrt(static_cast<double>(end));
        const double bounded =
            side_ * std::sqrt(std::min(kMaxNeighbours / count, 1.0) / 3.14159265);
        const Neighbours near(
            points_, side_,
            std::min({kReachSpacings * spacing, side_ / 2, std::max(bounded, spacing / 8)}));
        // Points whose position in this stage is given count from its start: the free ones keep
        // clear of them.
        std::vector<char> counted = placed_;
        for (std::size_t p = order_.size(); p < end && !fixed_.empty(); ++p)
            if (fixed_[p] >= 0)
                counted[static_cast<std::size_t>(fixed_[p])] = true;
        std::vector<double> all(points_.size());
        std::vector<double> filled(points_.size());
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            near.around(i, [&](std::uint32_t j, double k) {
                all[i] += k;
                filled[i] += counted[j] ? k : 0;
            });
        std::priority_queue<Candidate> heap;
        const auto candidate = [&](std::uint32_t i) {
            return Candidate{filled[i] / all[i], base::hash64(seed_, 1, i), i};
        };
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            if (!placed_[i] && !bound_[i])
                heap.push(candidate(i));
        while (order_.size() < end) {
            const std::uint32_t next = next_point(heap, candidate);
            placed_[next] = true;
            order_.push_back(next);
            if (!counted[next])
                near.around(next, [&](std::uint32_t j, double k) { filled[j] += k; });
        }
    }

    template<typename Make>
    std::uint32_t next_point(std::priority_queue<Candidate>& heap, const Make& candidate) {
        const std::int32_t given = fixed_.empty() ? -1 : fixed_[order_.size()];
        if (given >= 0)
            return static_cast<std::uint32_t>(given);
        // A fill only grows within a stage, so the top is the least once its own number is fresh.
        for (;;) {
            const Candidate top = heap.top();
            heap.pop();
            const Candidate fresh = candidate(top.point);
            if (fresh.fill <= top.fill)
                return top.point;
            heap.push(fresh);
        }
    }

    std::span<const vec2> points_;
    double side_;
    std::span<const std::int32_t> fixed_;
    std::uint64_t seed_;
    std::vector<char> placed_;
    std::vector<char> bound_; ///< has a place in fixed_
    std::vector<std::uint32_t> order_;
};

} // namespace

std::vector<std::uint32_t> progressive_order(std::span<const vec2> points, double side,
                                             std::span<const std::int32_t> fixed,
                                             std::uint64_t seed) {
    return Order(points, side, fixed, seed).run();
}

} // namespace sward::texgen
