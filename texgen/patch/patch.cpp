// SPDX-License-Identifier: Apache-2.0
#include "texgen/patch/patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/angles.h"
#include "base/hash.h"
#include "base/log.h"
#include "texgen/patch/patch_size.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

using shared::BladeRecord;
using shared::vec2;
using shared::vec3;

enum Stream : std::uint64_t { kShape = 100000, kRankTie, kSeedShift };

constexpr double kPi = std::numbers::pi;
using base::kDegree;
constexpr double kFacingSpread = 40 * kDegree; // a blade bends over its flat side, give or take
constexpr double kTuftSpread = 50 * kDegree;   // blades of a tuft lean away from its middle

/// The random numbers of one blade, in a fixed order.
class Draw {
public:
    Draw(const Preset& preset, std::uint64_t id)
        : seed_(static_cast<std::uint64_t>(preset.seed)), id_(id) {}
    double unit() { return base::hash_unit(seed_, kShape, id_ * 16 + next_++); }
    double spread() { return unit() * 2 - 1; }
    double in(const Range& r) { return std::lerp(r.low, r.high, unit()); }
    /// Tends to the middle, as grown things do.
    double about(const Range& r) { return std::lerp(r.low, r.high, (unit() + unit()) / 2); }

private:
    std::uint64_t seed_;
    std::uint64_t id_;
    std::uint64_t next_ = 0;
};

BladeRecord grow(const Preset& preset, const Sprout& sprout) {
    const Species& species = preset.species[sprout.species];
    Draw draw(preset, sprout.id);
    const double out = std::hypot(sprout.out_x, sprout.out_z);
    const double length = draw.about(species.length_m);
    const double droop = draw.in(species.droop);
    double lean_share = draw.unit();
    double azimuth = draw.unit() * 2 * kPi;
    if (out > 0) { // upright in the tuft's middle, outward at its rim
        azimuth = std::atan2(sprout.out_z, sprout.out_x) + draw.spread() * kTuftSpread;
        lean_share = (lean_share + out) / 2;
    }
    const double lean =
        std::lerp(species.lean_deg.low, species.lean_deg.high, lean_share) * kDegree;
    const double weight = droop * kDroopDeg * length / species.length_m.high;
    const double bend = (draw.in(species.curvature_deg) + weight) * kDegree;
    const RestCurve curve = rest_curve(length, lean, bend, azimuth);
    const double width = draw.about(species.width_m);
    const double facing = azimuth + kPi / 2 + draw.spread() * kFacingSpread;
    BladeRecord blade;
    // A root just below the side may round up to it in float; the torus puts it at 0.
    const auto on_torus = [&](double v) {
        const auto f = static_cast<float>(v);
        return f >= static_cast<float>(preset.side_m) ? 0.0f : f;
    };
    blade.root = {on_torus(sprout.x), on_torus(sprout.z), 0, 0};
    blade.v1 = shared::vec4(curve.v1, static_cast<float>(width / 2));
    blade.v2 = shared::vec4(curve.v2, static_cast<float>(draw.in(species.stiffness)));
    const double turn = facing - 2 * kPi * std::floor(facing / (2 * kPi));
    blade.shape = {static_cast<float>(turn), static_cast<float>(curve_length(curve.v1, curve.v2)),
                   static_cast<float>(droop), static_cast<float>(sprout.species)};
    return blade;
}

/// Number 0..255 of each position of `count`, with equal counts, as the float a texel decodes to.
float quantised(std::size_t position, std::size_t count) {
    return (static_cast<float>(position * 256 / count) + 0.5f) / 256.0f;
}

/// Seed position of each rank position: the golden-ratio sequence sorted, so that any run of ranks
/// holds all seeds evenly (neither hand-over nor mask nor slice choice disturbs the others).
std::vector<std::size_t> seed_positions(std::size_t count, std::uint64_t seed) {
    const double shift = base::hash_unit(seed, kSeedShift, 0);
    std::vector<double> key(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double turned = static_cast<double>(i) * (std::numbers::phi - 1) + shift;
        key[i] = turned - std::floor(turned);
    }
    std::vector<std::size_t> by_key(count);
    std::iota(by_key.begin(), by_key.end(), std::size_t{0});
    std::ranges::sort(by_key, [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
    std::vector<std::size_t> position(count);
    for (std::size_t p = 0; p < count; ++p)
        position[by_key[p]] = p;
    return position;
}

/// The blades of one variant by rising rank, and the point at each position.
std::vector<BladeRecord> grow_variant(const Preset& preset, const Roots& roots, std::size_t variant,
                                      std::span<const std::int32_t> fixed,
                                      std::vector<std::uint32_t>& order) {
    std::vector<BladeRecord> grown;
    std::vector<vec2> points;
    for (const auto* part : {&roots.border, &roots.interior[variant]})
        for (const Sprout& sprout : *part) {
            grown.push_back(grow(preset, sprout));
            points.emplace_back(grown.back().root.x, grown.back().root.y);
        }
    const std::uint64_t tie = base::hash64(static_cast<std::uint64_t>(preset.seed), kRankTie, 0);
    order = progressive_order(points, preset.side_m, fixed, tie);
    std::vector<BladeRecord> sorted;
    sorted.reserve(grown.size());
    for (const std::uint32_t point : order)
        sorted.push_back(grown[point]);
    return sorted;
}

} // namespace

RestCurve rest_curve(double length, double lean, double bend, double azimuth) {
    // Both legs equal and along the arc's end tangents: the parabola nearest to the arc.
    const double end = lean + bend;
    const double out1 = std::sin(lean), up1 = std::cos(lean);
    const double out2 = out1 + std::sin(end), up2 = up1 + std::cos(end);
    const auto at = [&](double out, double up) {
        return vec3(static_cast<float>(out * std::cos(azimuth)), static_cast<float>(up),
                    static_cast<float>(out * std::sin(azimuth)));
    };
    const auto scale = static_cast<float>(length / curve_length(at(out1, up1), at(out2, up2)));
    return {at(out1, up1) * scale, at(out2, up2) * scale};
}

double curve_length(vec3 v1, vec3 v2) {
    // |B'(v)| = 2 |v1 + v (v2 - 2 v1)| is the root of a quadratic in v; its integral over [0, 1].
    const glm::dvec3 p = v1;
    const glm::dvec3 q = glm::dvec3(v2) - 2.0 * p;
    const double a = glm::dot(q, q), b = 2 * glm::dot(p, q), c = glm::dot(p, p);
    if (a < 1e-9 * c) // straight: speed changes by less than rounding
        return 2 * std::sqrt(c + b / 2);
    const auto integral = [&](double v) {
        const double s = std::sqrt(std::max(a * v * v + b * v + c, 0.0));
        const double ra = std::sqrt(a);
        return (2 * a * v + b) / (4 * a) * s +
               (4 * a * c - b * b) / (8 * a * ra) *
                   std::log(std::abs(2 * ra * s + 2 * a * v + b) + 1e-300);
    };
    return 2 * (integral(1) - integral(0));
}

Patch unranked_patch(const Preset& preset, int threads) {
    const Roots roots = scatter_roots(preset);
    const std::size_t border = roots.border.size(), each = border + roots.interior.front().size();
    Patch patch;
    patch.side_m = preset.side_m;
    for (const Species& species : preset.species)
        patch.looks.push_back(appearance(species));
    patch.blades.resize(each * roots.interior.size());
    for (std::size_t v = 0; v <= roots.interior.size(); ++v)
        patch.variant_begin.push_back(static_cast<std::uint32_t>(v * each));
    constexpr std::size_t kRun = 1024;
    parallel_for((each + kRun - 1) / kRun, resolve_threads(threads), [&](std::size_t run, int) {
        for (std::size_t i = run * kRun; i < std::min(each, (run + 1) * kRun); ++i)
            for (std::size_t v = 0; v < roots.interior.size(); ++v)
                patch.blades[v * each + i] = i >= border
                                                 ? grow(preset, roots.interior[v][i - border])
                                             : v == 0 ? grow(preset, roots.border[i])
                                                      : patch.blades[i];
    });
    return patch;
}

Patch generate_patch(const Preset& preset, int threads) {
    const Roots roots = scatter_roots(preset);
    const std::size_t border = roots.border.size();
    const std::vector<std::size_t> seeds = seed_positions(border + roots.interior.front().size(),
                                                          static_cast<std::uint64_t>(preset.seed));
    std::vector<std::vector<BladeRecord>> variants(roots.interior.size());
    // The first variant decides the border's ranks; the others fill in around them.
    std::vector<std::int32_t> fixed;
    std::vector<std::uint32_t> order;
    base::Progress progress("patch", variants.size());
    variants[0] = grow_variant(preset, roots, 0, fixed, order);
    progress.advance();
    for (const std::uint32_t point : order)
        fixed.push_back(point < border ? static_cast<std::int32_t>(point) : -1);
    parallel_for(variants.size() - 1, resolve_threads(threads), [&](std::size_t v, int) {
        std::vector<std::uint32_t> own;
        variants[v + 1] = grow_variant(preset, roots, v + 1, fixed, own);
        progress.advance();
    });
    Patch patch;
    patch.side_m = preset.side_m;
    for (const Species& species : preset.species)
        patch.looks.push_back(appearance(species));
    patch.variant_begin.push_back(0);
    for (std::vector<BladeRecord>& blades : variants) {
        for (std::size_t p = 0; p < blades.size(); ++p) {
            blades[p].root.z = quantised(p, blades.size());
            blades[p].root.w = quantised(seeds[p], blades.size());
        }
        patch.blades.insert(patch.blades.end(), blades.begin(), blades.end());
        patch.variant_begin.push_back(static_cast<std::uint32_t>(patch.blades.size()));
    }
    return patch;
}

} // namespace sward::texgen
