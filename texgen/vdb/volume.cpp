// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/volume.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "grass/set_files.h"
#include "shared/shading.h"
#include "texgen/patch/canopy.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_writer.h"

namespace sward::texgen {
namespace {

/// Area of one blade in one voxel.
struct Deposit {
    std::uint64_t voxel = 0; ///< y, z, x
    std::uint32_t blade = 0;
    float area = 0;  ///< square metres
    float along = 0; ///< v there
    bool operator<(const Deposit& o) const {
        return std::tie(voxel, blade) < std::tie(o.voxel, o.blade);
    }
};

constexpr int kPerVoxel = 4; // samples a voxel width, along and across a blade
constexpr int kLeastSteps = 16;

const shared::GrassAppearance& look_of(const grass::GrassSet& set,
                                       const shared::BladeRecord& blade) {
    return set.species[species_of(blade)].look;
}

/// A blade's surface B(v) + w across, |w| <= half(v).
class Surface {
public:
    Surface(const grass::GrassSet& set, const shared::BladeRecord& blade)
        : outline_(look_of(set, blade).outline), root_(blade.root.x, 0, blade.root.y),
          v1_(blade.v1), v2_(blade.v2),
          across_(std::cos(blade.shape.x), 0, std::sin(blade.shape.x)), half_(blade.v1.w) {}

    [[nodiscard]] glm::dvec3 at(double v) const {
        return root_ + 2 * v * (1 - v) * v1_ + v * v * v2_;
    }
    [[nodiscard]] double width(double v) const {
        return 2 * half_ * shared::blade_width_at(static_cast<float>(v), outline_);
    }
    /// |dB/dv x across|: the width direction is not square to the curve.
    [[nodiscard]] double stretch(double v) const {
        return glm::length(glm::cross(2.0 * ((1 - v) * v1_ + v * (v2_ - v1_)), across_));
    }
    [[nodiscard]] glm::dvec3 across() const { return across_; }

private:
    shared::BladeOutline outline_;
    glm::dvec3 root_, v1_, v2_, across_;
    double half_;
};

/// Cuts a blade's surface into small pieces and sums their areas by voxel.
class Sampler {
public:
    Sampler(double voxel_m, int cells) : voxel_m_(voxel_m), cells_(cells) {}

    void add(const Surface& blade, double length, std::uint32_t number, std::vector<Deposit>& out) {
        own_.clear();
        const int steps =
            std::max(kLeastSteps, static_cast<int>(std::ceil(length / voxel_m_ * kPerVoxel)));
        for (int i = 0; i < steps; ++i) {
            const double v = (i + 0.5) / steps;
            const glm::dvec3 centre = blade.at(v);
            const double width = blade.width(v);
            const int wide = std::max(1, static_cast<int>(std::ceil(width / voxel_m_ * kPerVoxel)));
            const auto area = static_cast<float>(blade.stretch(v) / steps * width / wide);
            for (int j = 0; j < wide; ++j)
                own_.push_back({key(centre + blade.across() * (width * ((j + 0.5) / wide - 0.5))),
                                number, area, static_cast<float>(v)});
        }
        std::ranges::stable_sort(own_, {}, &Deposit::voxel);
        for (std::size_t i = 0; i < own_.size();) {
            Deposit sum = own_[i];
            const std::size_t first = i;
            for (++i; i < own_.size() && own_[i].voxel == sum.voxel; ++i)
                sum.area += own_[i].area;
            sum.along = own_[(first + i) / 2].along;
            out.push_back(sum);
        }
    }

private:
    std::uint64_t key(glm::dvec3 p) const {
        const auto wrapped = [&](double v) {
            const int i = static_cast<int>(std::floor(v / voxel_m_)) % cells_;
            return static_cast<std::uint64_t>(i < 0 ? i + cells_ : i);
        };
        const auto y = static_cast<std::uint64_t>(std::max(0.0, std::floor(p.y / voxel_m_)));
        return y << 32 | wrapped(p.z) << 16 | wrapped(p.x);
    }

    double voxel_m_;
    int cells_;
    std::vector<Deposit> own_;
};

/// The mean of the terms of light, by area and height.
Species mean_light(const grass::GrassSet& set, const std::vector<Deposit>& deposits) {
    std::vector<double> weights(set.species.size());
    double whole = 0;
    for (const Deposit& d : deposits) {
        const double weight =
            static_cast<double>(d.area) * (static_cast<double>(d.voxel >> 32) + 0.5);
        weights[species_of(set.blades[d.blade])] += weight;
        whole += weight;
    }
    if (!(whole > 0))
        return {};
    Species mean{.kd = 0, .pd = 0, .ks = 0, .ps = 0, .translucency = 0};
    for (std::size_t s = 0; s < weights.size(); ++s) {
        const shared::GrassAppearance& look = set.species[s].look;
        const double share = weights[s] / whole;
        mean.kd += share * static_cast<double>(look.gloss.diffuse);
        mean.pd += share * static_cast<double>(look.gloss.diffuse_power);
        mean.ks += share * static_cast<double>(look.gloss.specular);
        mean.ps += share * static_cast<double>(look.gloss.specular_power);
        mean.translucency += share * static_cast<double>(look.translucency);
    }
    return mean;
}

/// Sorted deposits to voxels.
void gather(const grass::GrassSet& set, const std::vector<Deposit>& deposits, Volume& out) {
    const auto face = static_cast<float>(out.voxel_m * out.voxel_m);
    for (std::size_t i = 0; i < deposits.size();) {
        const std::uint64_t voxel = deposits[i].voxel;
        Deposit most = deposits[i];
        float area = 0;
        for (; i < deposits.size() && deposits[i].voxel == voxel; ++i) {
            area += deposits[i].area;
            if (deposits[i].area > most.area)
                most = deposits[i];
        }
        if (area <= 0)
            continue;
        const shared::BladeRecord& blade = set.blades[most.blade];
        out.at.push_back({static_cast<std::uint16_t>(voxel & 0xFFFF),
                          static_cast<std::uint16_t>(voxel >> 32),
                          static_cast<std::uint16_t>(voxel >> 16 & 0xFFFF)});
        out.density.push_back(area / face);
        out.tangent.push_back(
            shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2), most.along));
        out.colour.push_back(shared::blade_albedo(look_of(set, blade), {blade.root.z, blade.root.w},
                                                  most.along, 1.0f));
        out.rank.push_back(blade.root.z);
        out.others.push_back((area - most.area) / face);
        out.seed.push_back(blade.root.w);
        out.cells.y = std::max(out.cells.y, out.at.back().y + 1);
    }
}

} // namespace

double blade_area(const grass::GrassSet& set, const shared::BladeRecord& blade) {
    const Surface surface(set, blade);
    constexpr int kSteps = 2048;
    double area = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double v = (i + 0.5) / kSteps;
        area += surface.width(v) * surface.stretch(v) / kSteps;
    }
    return area;
}

Volume rasterise_volume(const grass::GrassSet& set) {
    Volume out;
    const int cells = set.levels.front().layers.width;
    out.voxel_m = static_cast<double>(set.side_m) / cells;
    out.cells = {cells, 0, cells};
    out.period_m = set.side_m;
    out.canopy_m = static_cast<double>(set.canopy_m);
    out.preset = set.name;
    out.set_seed = set.seed;
    out.format_version = grass::kSetFormatVersion;
    const std::span blades = std::span(set.blades).subspan(0, set.variant_begin[1]);
    Sampler sampler(out.voxel_m, cells);
    std::vector<Deposit> deposits;
    for (std::uint32_t b = 0; b < blades.size(); ++b)
        sampler.add(Surface(set, blades[b]), blades[b].shape.y, b, deposits);
    std::sort(deposits.begin(), deposits.end());
    gather(set, deposits, out);
    out.light = mean_light(set, deposits);
    return out;
}

std::vector<std::byte> encode_volume(const grass::GrassSet& set) {
    return encode_vdb(rasterise_volume(set));
}

Volume read_volume(const std::filesystem::path& set_directory) {
    const std::vector<std::byte> bytes = grass::read_set_file(set_directory, grass::kVolumeFile);
    return VdbFile(bytes, set_directory / grass::kVolumeFile).read_volume({});
}

VolumeInfo inspect_volume(const std::vector<std::byte>& bytes, const std::filesystem::path& name) {
    const VdbFile file(bytes, name);
    file.check_grids();
    VolumeInfo info;
    for (const VdbGridInfo& grid : file.grids())
        info.grids.push_back(grid.name);
    if (std::ranges::find(info.grids, "density") == info.grids.end())
        return info;
    const Volume volume = file.read_volume({.companions = false});
    info.active_voxels = volume.at.size();
    info.voxel_m = volume.voxel_m;
    for (const float density : volume.density)
        info.density_sum += density;
    return info;
}

} // namespace sward::texgen
