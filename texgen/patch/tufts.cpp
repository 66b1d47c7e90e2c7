// SPDX-License-Identifier: Apache-2.0
// Where blades stand (J2): single blades uniform by area, tufts around Poisson-disk centres. What
// stands in the border is drawn once; each variant fills its own interior with as many blades as
// the others.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"
#include "texgen/patch/patch.h"

namespace sward::texgen {
namespace {

// Streams of the counter-based random numbers; the variant's interior adds kVariantStep * (variant
// + 1).
enum Stream : std::uint64_t {
    kSingle = 1,
    kTuftCentre,
    kTuftSize,
    kTuftBlade,
    kVariantStep = 64,
    kSpecies = 90000
};

struct Centre {
    double x, z;
};

double wrap_distance(double d, double side) {
    return d - side * std::round(d / side);
}

double edge_distance(double x, double z, double side) {
    return std::min(std::min(x, side - x), std::min(z, side - z));
}

/// Centres by cells of a toroidal grid, so that a dart asks its neighbours alone.
class CentreGrid {
public:
    /// `disk`: the largest that near() is asked for.
    CentreGrid(double side, double disk)
        : side_(side), cells_(std::clamp(static_cast<int>(side / disk), 1, 512)),
          buckets_(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_)) {}

    void add(const Centre& c) { bucket(cell(c.x), cell(c.z)).push_back(c); }

    [[nodiscard]] bool near(const Centre& c, double disk) {
        if (cells_ < 3) // the rings of cells would visit some twice: harmless, but no gain either
            return std::ranges::any_of(buckets_, [&](const auto& b) { return any(b, c, disk); });
        for (int dz = -1; dz <= 1; ++dz)
            for (int dx = -1; dx <= 1; ++dx)
                if (any(bucket(cell(c.x) + dx, cell(c.z) + dz), c, disk))
                    return true;
        return false;
    }

private:
    [[nodiscard]] int cell(double v) const {
        return std::clamp(static_cast<int>(v / side_ * cells_), 0, cells_ - 1);
    }
    std::vector<Centre>& bucket(int x, int z) {
        return buckets_[static_cast<std::size_t>((z + cells_) % cells_ * cells_ +
                                                 (x + cells_) % cells_)];
    }
    [[nodiscard]] bool any(const std::vector<Centre>& centres, const Centre& c, double disk) const {
        return std::ranges::any_of(centres, [&](const Centre& o) {
            return std::hypot(wrap_distance(c.x - o.x, side_), wrap_distance(c.z - o.z, side_)) <
                   disk;
        });
    }

    double side_;
    int cells_;
    std::vector<std::vector<Centre>> buckets_;
};

class Scatter {
public:
    /// `first_id`: of this species' first root.
    Scatter(const Preset& preset, std::size_t species, std::uint64_t first_id)
        : preset_(preset), species_(preset.species[species]),
          number_(static_cast<std::uint32_t>(species)), side_(preset.side_m),
          seed_(base::hash64(static_cast<std::uint64_t>(preset.seed), kSpecies, species)),
          border_(border_width(preset)), next_id_(first_id) {}

    /// Appends `total` roots a variant. Returns the first id that is free.
    std::uint64_t run(std::size_t total, Roots& roots) {
        const double per_tuft = (species_.tuft_blades.low + species_.tuft_blades.high) / 2;
        tufted_ = static_cast<std::size_t>(
            std::llround(static_cast<double>(total) * species_.tuft_share));
        tufts_ = static_cast<std::size_t>(std::llround(static_cast<double>(tufted_) / per_tuft));
        if (tufts_ == 0)
            tufted_ = 0;
        single_blades(total - tufted_, roots);
        tuft_blades(roots);
        return next_id_;
    }

private:
    double unit(std::uint64_t stream, std::uint64_t index) const {
        return base::hash_unit(seed_, stream, index);
    }
    static std::uint64_t own(std::uint64_t variant) { return kVariantStep * (variant + 1); }

    void single_blades(std::size_t count, Roots& roots) {
        const std::size_t others = roots.border.size();
        for (std::size_t i = 0; i < count; ++i) {
            const Sprout s{unit(kSingle, 2 * i) * side_, unit(kSingle, 2 * i + 1) * side_,
                           next_id_++, number_};
            if (edge_distance(s.x, s.z, side_) < border_)
                roots.border.push_back(s);
        }
        const std::size_t inside = count - (roots.border.size() - others);
        const double width = side_ - 2 * border_;
        for (std::size_t v = 0; v < roots.interior.size(); ++v)
            for (std::size_t i = 0; i < inside; ++i) {
                const double x = border_ + unit(own(v) + kSingle, 2 * i) * width;
                const double z = border_ + unit(own(v) + kSingle, 2 * i + 1) * width;
                roots.interior[v].push_back({x, z, next_id_++, number_});
            }
    }

    void tuft_blades(Roots& roots) {
        if (tufts_ == 0)
            return;
        // A tuft whose blades may stand in the border belongs to the border as a whole.
        const double rim = border_ + species_.tuft_radius_m.high;
        std::vector<Centre> all;
        throw_darts(kTuftCentre, tufts_, 0, all);
        std::vector<Centre> shared_centres;
        for (const Centre& c : all)
            if (edge_distance(c.x, c.z, side_) < rim)
                shared_centres.push_back(c);
        const double share =
            static_cast<double>(shared_centres.size()) / static_cast<double>(tufts_);
        const auto rim_blades =
            static_cast<std::size_t>(std::llround(static_cast<double>(tufted_) * share));
        grow_tufts(kTuftSize, shared_centres, rim_blades, roots.border);
        for (std::size_t v = 0; v < roots.interior.size(); ++v) {
            std::vector<Centre> centres = shared_centres;
            throw_darts(own(v) + kTuftCentre, tufts_ - shared_centres.size(), rim, centres);
            centres.erase(centres.begin(),
                          centres.begin() + static_cast<std::ptrdiff_t>(shared_centres.size()));
            grow_tufts(own(v) + kTuftSize, centres, tufted_ - rim_blades, roots.interior[v]);
        }
    }

    /// Appends `count` centres inside the rim by dart throwing; the disk shrinks while darts find
    /// no place, so that the count is met exactly.
    void throw_darts(std::uint64_t stream, std::size_t count, double rim,
                     std::vector<Centre>& centres) const {
        double disk = std::sqrt(0.68 * side_ * side_ / static_cast<double>(tufts_));
        const double width = side_ - 2 * rim;
        CentreGrid grid(side_, disk);
        for (const Centre& c : centres)
            grid.add(c);
        std::uint64_t dart = 0;
        int misses = 0;
        for (std::size_t placed = 0; placed < count;) {
            const Centre c{rim + unit(stream, 2 * dart) * width,
                           rim + unit(stream, 2 * dart + 1) * width};
            ++dart;
            if (!grid.near(c, disk)) {
                grid.add(c);
                centres.push_back(c);
                ++placed;
                misses = 0;
            } else if (++misses > 200) {
                disk *= 0.95;
                misses = 0;
            }
        }
    }

    /// Shares `blades` among the tufts by their random sizes (largest remainder by running sum).
    void grow_tufts(std::uint64_t stream, const std::vector<Centre>& centres, std::size_t blades,
                    std::vector<Sprout>& into) {
        std::vector<double> weight(centres.size());
        double sum = 0;
        for (std::size_t t = 0; t < centres.size(); ++t) {
            weight[t] =
                std::lerp(species_.tuft_blades.low, species_.tuft_blades.high, unit(stream, 2 * t));
            sum += weight[t];
        }
        double running = 0;
        std::size_t grown = 0;
        for (std::size_t t = 0; t < centres.size(); ++t) {
            running += weight[t];
            const auto until =
                static_cast<std::size_t>(std::llround(static_cast<double>(blades) * running / sum));
            const double radius = std::lerp(species_.tuft_radius_m.low, species_.tuft_radius_m.high,
                                            unit(stream, 2 * t + 1));
            for (; grown < until; ++grown)
                into.push_back(
                    tuft_blade(stream - kTuftSize + kTuftBlade, grown, centres[t], radius));
        }
        // No centre in this part: its blades stand singly, so that the total holds.
        if (centres.empty())
            for (; grown < blades; ++grown)
                into.push_back(tuft_blade(stream - kTuftSize + kTuftBlade, grown,
                                          {side_ / 2, side_ / 2}, 0.1 * side_));
    }

    Sprout tuft_blade(std::uint64_t stream, std::uint64_t index, const Centre& centre,
                      double radius) {
        const double angle = unit(stream, 2 * index) * 2 * std::numbers::pi;
        const double out =
            std::pow(unit(stream, 2 * index + 1), 0.7); // denser towards the centre than by area
        Sprout s;
        s.out_x = out * std::cos(angle);
        s.out_z = out * std::sin(angle);
        s.x = centre.x + s.out_x * radius;
        s.z = centre.z + s.out_z * radius;
        s.x -= side_ * std::floor(s.x / side_);
        s.z -= side_ * std::floor(s.z / side_);
        s.id = next_id_++;
        s.species = number_;
        return s;
    }

    const Preset& preset_;
    const Species& species_;
    std::uint32_t number_;
    double side_;
    std::uint64_t seed_;
    double border_;
    std::size_t tufted_ = 0;
    std::size_t tufts_ = 0;
    std::uint64_t next_id_;
};

} // namespace

Roots scatter_roots(const Preset& preset) {
    Roots roots;
    roots.interior.resize(static_cast<std::size_t>(preset.variants));
    const std::vector<std::size_t> counts = species_counts(preset);
    std::uint64_t next_id = 0;
    for (std::size_t s = 0; s < counts.size(); ++s)
        next_id = Scatter(preset, s, next_id).run(counts[s], roots);
    return roots;
}

} // namespace sward::texgen
