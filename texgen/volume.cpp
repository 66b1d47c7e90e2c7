// SPDX-License-Identifier: Apache-2.0
// The only file that includes OpenVDB here: slow to compile, plain arrays at its border.
#include "texgen/volume.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

#include <openvdb/io/Archive.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include "base/error.h"
#include "base/hash.h"
#include "texgen/canopy.h"

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

/// Cuts a blade's surface into small squares and sums their areas by voxel.
class Sampler {
public:
    Sampler(double voxel_m, int cells) : voxel_m_(voxel_m), cells_(cells) {}

    void add(const shared::BladeRecord& blade, std::uint32_t number,
             std::vector<Deposit>& out) const {
        std::vector<Deposit> own;
        const double length = blade.shape.y;
        const int steps = std::max(8, static_cast<int>(std::ceil(length / voxel_m_ * kPerVoxel)));
        const glm::dvec3 root(blade.root.x, 0, blade.root.y), v1(blade.v1), v2(blade.v2);
        const glm::dvec3 across(std::cos(blade.shape.x), 0, std::sin(blade.shape.x));
        for (int i = 0; i < steps; ++i) {
            const double v = (i + 0.5) / steps;
            const glm::dvec3 centre = root + 2 * v * (1 - v) * v1 + v * v * v2;
            const double speed = 2 * glm::length((1 - v) * v1 + v * (v2 - v1)); // |dB/dv|
            const double width = 2 * blade.v1.w * (1 - v * v);
            const int wide = std::max(1, static_cast<int>(std::ceil(width / voxel_m_ * kPerVoxel)));
            for (int j = 0; j < wide; ++j) {
                const glm::dvec3 p = centre + across * (width * ((j + 0.5) / wide - 0.5));
                own.push_back({key(p), number, static_cast<float>(speed / steps * width / wide),
                               static_cast<float>(v)});
            }
        }
        std::ranges::stable_sort(own, {}, &Deposit::voxel);
        for (std::size_t i = 0; i < own.size();) {
            Deposit sum = own[i];
            const std::size_t first = i;
            for (++i; i < own.size() && own[i].voxel == sum.voxel; ++i)
                sum.area += own[i].area;
            sum.along = own[(first + i) / 2].along;
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
};

struct Grids {
    openvdb::FloatGrid::Ptr density = openvdb::FloatGrid::create(0);
    openvdb::Vec3SGrid::Ptr tangent = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    openvdb::FloatGrid::Ptr rank = openvdb::FloatGrid::create(0);
    openvdb::FloatGrid::Ptr seed = openvdb::FloatGrid::create(0);

    [[nodiscard]] openvdb::GridPtrVec all() const { return {density, tangent, rank, seed}; }
};

void fill(Grids& grids, const std::vector<Deposit>& deposits,
          std::span<const shared::BladeRecord> blades, double voxel_m) {
    auto density = grids.density->getAccessor();
    auto tangent = grids.tangent->getAccessor();
    auto rank = grids.rank->getAccessor();
    auto seed = grids.seed->getAccessor();
    for (std::size_t i = 0; i < deposits.size();) {
        const std::uint64_t voxel = deposits[i].voxel;
        Deposit most = deposits[i];
        float area = 0;
        for (; i < deposits.size() && deposits[i].voxel == voxel; ++i) {
            area += deposits[i].area;
            if (deposits[i].area > most.area)
                most = deposits[i];
        }
        const shared::BladeRecord& blade = blades[most.blade];
        const shared::vec3 t =
            shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2), most.along);
        const openvdb::Coord at(static_cast<int>(voxel & 0xFFFF), static_cast<int>(voxel >> 32),
                                static_cast<int>(voxel >> 16 & 0xFFFF));
        density.setValue(at, std::min(1.0f, area / static_cast<float>(voxel_m * voxel_m)));
        tangent.setValue(at, openvdb::Vec3f(t.x, t.y, t.z));
        rank.setValue(at, blade.root.z);
        seed.setValue(at, blade.root.w);
    }
}

void label(const Grids& grids, const grass::GrassSet& set, double voxel_m) {
    grids.density->setName("density");
    grids.tangent->setName("tangent");
    grids.rank->setName("rank");
    grids.seed->setName("seed");
    grids.density->setGridClass(openvdb::GRID_FOG_VOLUME);
    grids.tangent->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    for (const openvdb::GridBase::Ptr& grid : grids.all()) {
        const auto transform = openvdb::math::Transform::createLinearTransform(voxel_m);
        transform->postTranslate(
            openvdb::Vec3d(voxel_m / 2)); // a voxel's value stands at its middle
        grid->setTransform(transform);
        grid->setSaveFloatAsHalf(true);
        grid->setCreator("Sward texgen");
        grid->insertMeta("period_m", openvdb::FloatMetadata(set.side_m));
        grid->insertMeta("preset", openvdb::StringMetadata(set.name));
    }
}

/// OpenVDB's writer onto a stream of our own, with the offsets that let tools read grid by grid
/// (io::Stream leaves them out, io::File writes past full disks).
class StreamArchive : public openvdb::io::Archive {
public:
    std::string bytes(const openvdb::GridPtrVec& grids) const {
        std::ostringstream stream(std::ios::binary);
        write(stream, grids, true, openvdb::MetaMap());
        std::string text = std::move(stream).str();
        name_by_content(text);
        return text;
    }

private:
    /// The file's random unique tag becomes one of its content, so that the same set gives the same
    /// bytes.
    void name_by_content(std::string& text) const {
        const std::string tag = getUniqueTag();
        const std::size_t at = text.substr(0, 256).find(tag);
        if (at == std::string::npos || tag.size() != 36)
            throw base::Error(base::ExitCode::kFailure, "volume.vdb: no unique tag in the header");
        text.replace(at, tag.size(), tag.size(), '0');
        std::string named = base::sha256_hex(text).substr(0, 36);
        for (const std::size_t dash : {8, 13, 18, 23})
            named[dash] = '-';
        text.replace(at, named.size(), named);
    }
};

} // namespace

std::vector<std::byte> encode_volume(const grass::GrassSet& set) {
    openvdb::initialize();
    const int cells = set.levels.front().layers.width;
    const double voxel_m = static_cast<double>(set.side_m) / cells;
    const std::span blades = std::span(set.blades).subspan(0, set.variant_begin[1]);
    const Sampler sampler(voxel_m, cells);
    std::vector<Deposit> deposits;
    for (std::uint32_t b = 0; b < blades.size(); ++b)
        sampler.add(blades[b], b, deposits);
    std::sort(deposits.begin(), deposits.end());
    Grids grids;
    fill(grids, deposits, blades, voxel_m);
    label(grids, set, voxel_m);
    const std::string text = StreamArchive().bytes(grids.all());
    const auto* raw = reinterpret_cast<const std::byte*>(text.data());
    return {raw, raw + text.size()};
}

VolumeInfo inspect_volume(const std::vector<std::byte>& bytes) {
    openvdb::initialize();
    std::istringstream stream(
        std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), std::ios::binary);
    VolumeInfo info;
    const openvdb::GridPtrVecPtr grids = openvdb::io::Stream(stream, false).getGrids();
    for (const openvdb::GridBase::Ptr& grid : *grids) {
        info.grids.push_back(grid->getName());
        const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        if (!density || grid->getName() != "density")
            continue;
        info.active_voxels = density->activeVoxelCount();
        info.voxel_m = density->voxelSize().x();
        for (auto value = density->cbeginValueOn(); value; ++value)
            info.density_sum += *value;
    }
    return info;
}

} // namespace sward::texgen
