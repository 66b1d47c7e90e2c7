// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb_file.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "texgen/vdb_reader.h"

namespace sward::texgen {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3SGrid;

constexpr const char* kPeriodKey = "period_m";

/// Index to world of a grid that only scales (alike on all axes) and shifts.
struct Placement {
    double voxel = 0;
    glm::dvec3 origin{0};
    [[nodiscard]] bool on(const Placement& o) const {
        return std::abs(voxel - o.voxel) < 1e-4 * voxel &&
               glm::length(origin - o.origin) < 1e-2 * voxel;
    }
};

std::string printed(const Coord& c) {
    return fmt::format("({}, {}, {})", c.x(), c.y(), c.z());
}

bool finite(float v) { return std::isfinite(v); }
bool finite(const openvdb::Vec3f& v) {
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// visit(coord, value) for every active voxel, those of active tiles too.
template<typename Grid, typename Visit> void for_active(const Grid& grid, const Visit& visit) {
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        if (it.isVoxelValue()) {
            visit(it.getCoord(), *it);
            continue;
        }
        const openvdb::CoordBBox box = it.getBoundingBox();
        for (auto c = box.begin(); c != box.end(); ++c)
            visit(*c, *it);
    }
}

/// A voxel of the density on its way to its order.
struct Found {
    std::uint64_t key = 0; ///< y, z, x, 16 bits each
    float density = 0;
};

/// The file's axes to ours: z up becomes y up by a quarter turn about x.
glm::ivec3 turned(glm::ivec3 v, bool z_up) { return z_up ? glm::ivec3(v.x, v.z, -v.y) : v; }
glm::ivec3 turned_back(glm::ivec3 v, bool z_up) { return z_up ? glm::ivec3(v.x, -v.z, v.y) : v; }
glm::ivec3 vec(const Coord& c) { return {c.x(), c.y(), c.z()}; }

/// The steps of read_volume.
class VolumeReading {
public:
    VolumeReading(VdbReader& reader, const VolumeQuery& query) : reader_(reader), query_(query) {}

    Volume run() {
        read_density();
        if (!query_.companions)
            return std::move(out_);
        read_vectors("tangent", out_.tangent);
        for (glm::vec3& t : out_.tangent) {
            if (query_.z_up)
                t = {t.x, t.z, -t.y};
            const float length = glm::length(t);
            t = length > 1e-6f ? t / length : glm::vec3(0, 1, 0);
        }
        read_vectors(reader_.find("colour") >= 0 ? "colour" : "Cd", out_.colour);
        read_scalars("rank", out_.rank);
        read_scalars("seed", out_.seed);
        return std::move(out_);
    }

private:
    Placement placement_of(const openvdb::GridBase& grid) const {
        const std::string name = "grid " + base::printable(grid.getName()) + ": transform";
        if (!grid.transform().isLinear())
            reader_.refuse(name, "a frustum", "a scale and a shift");
        const openvdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();
        const Placement p{m(0, 0), {m(3, 0), m(3, 1), m(3, 2)}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (!(std::abs(m(i, j) - (i == j ? p.voxel : 0)) <= 1e-4 * p.voxel))
                    reader_.refuse(name, "a turn, a shear or unequal axes",
                                   "cubic voxels along the axes: resample the volume");
        if (!(p.voxel > 1e-9 && p.voxel < 1e9))
            reader_.refuse(name, fmt::format("voxels of {}", p.voxel), "a positive size");
        return p;
    }

    void read_density() {
        const int index = reader_.find("density");
        if (index < 0)
            reader_.refuse("grids", "no \"density\"", "a fog volume of that name");
        const openvdb::GridBase::Ptr base = reader_.load(index);
        const auto grid = openvdb::gridPtrCast<FloatGrid>(base);
        if (!grid)
            reader_.refuse("grid density", base->valueType(), "single floats");
        if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
            reader_.refuse("grid density", "a level set (distances)",
                           "a fog volume: convert it (Houdini: Convert VDB; Blender: Mesh to Volume)");
        placement_ = placement_of(*grid);
        std::vector<Found> found;
        collect(*grid, found);
        read_head(*grid);
        place(found);
    }

    void collect(const FloatGrid& grid, std::vector<Found>& found) {
        low_ = glm::ivec3(INT_MAX);
        glm::ivec3 high(INT_MIN);
        std::size_t count = 0;
        for_active(grid, [&](const Coord& c, float value) {
            if (!(value >= 0) || !finite(value))
                reader_.refuse("grid density: voxel " + printed(c), fmt::format("{}", value),
                               "0 or more (a level set?)");
            if (value == 0)
                return;
            const glm::ivec3 at = turned(vec(c), query_.z_up);
            low_ = glm::min(low_, at);
            high = glm::max(high, at);
            ++count;
        });
        if (count == 0)
            reader_.refuse("grid density", "no voxel above 0", "some grass");
        out_.cells = high - low_ + 1;
        found.reserve(count);
        for_active(grid, [&](const Coord& c, float value) {
            if (value == 0)
                return;
            const glm::ivec3 at = turned(vec(c), query_.z_up);
            const glm::u64vec3 k(at - low_);
            found.push_back({k.y << 32 | k.z << 16 | k.x, value});
        });
        std::ranges::sort(found, {}, &Found::key);
    }

    void read_head(const FloatGrid& grid) {
        out_.voxel_m = placement_.voxel * query_.scale;
        if (const auto m = grid.getMetadata<openvdb::FloatMetadata>(kPeriodKey))
            out_.period_m = m->value() * query_.scale;
        if (const auto m = grid.getMetadata<openvdb::Int32Metadata>("format_version"))
            out_.format_version = m->value();
        if (const auto m = grid.getMetadata<openvdb::Int64Metadata>("seed"))
            out_.set_seed = static_cast<std::uint64_t>(m->value());
        if (const auto m = grid.getMetadata<openvdb::StringMetadata>("preset");
            m && out_.format_version > 0)
            out_.preset = m->value().substr(0, 64);
        const double period = out_.period_m / out_.voxel_m;
        const auto whole = static_cast<int>(std::lround(std::clamp(period, 0.0, 1e6)));
        if (!(std::abs(period - whole) < 0.01) || whole > kMaxVdbSide ||
            whole < std::max(out_.cells.x, out_.cells.z)) {
            if (out_.period_m != 0)
                base::log_warning(fmt::format("{} {} is not a whole number of voxels that holds the volume: "
                                              "it is not used",
                                              kPeriodKey, out_.period_m));
            out_.period_m = 0;
            return;
        }
        // A volume that lies inside its period keeps its place.
        const glm::ivec3 high = low_ + out_.cells;
        const glm::ivec3 keep(low_.x >= 0 && high.x <= whole ? low_.x : 0, 0,
                              low_.z >= 0 && high.z <= whole ? low_.z : 0);
        shift_ = keep;
        out_.cells = {whole, out_.cells.y, whole};
    }

    void place(const std::vector<Found>& found) {
        out_.at.reserve(found.size());
        out_.density.reserve(found.size());
        for (const Found& f : found) {
            out_.at.push_back({static_cast<std::uint16_t>((f.key & 0xFFFF) + shift_.x),
                               static_cast<std::uint16_t>(f.key >> 32),
                               static_cast<std::uint16_t>((f.key >> 16 & 0xFFFF) + shift_.z)});
            out_.density.push_back(f.density);
        }
        low_ -= shift_;
    }

    /// take(i, value) with the grid's value at every voxel of the density: the nearest where their voxels differ.
    template<typename Grid, typename Take> void sample(int index, const Take& take) {
        const openvdb::GridBase::Ptr base = reader_.load(index);
        const auto grid = openvdb::gridPtrCast<Grid>(base);
        const std::string name = "grid " + base::printable(base->getName());
        if (!grid)
            reader_.refuse(name, base->valueType(), Grid().valueType());
        const Placement own = placement_of(*grid);
        const bool same = own.on(placement_);
        const auto values = grid->getConstAccessor();
        for (std::size_t i = 0; i < out_.at.size(); ++i) {
            const VoxelPlace& p = out_.at[i];
            glm::ivec3 c = turned_back(glm::ivec3(p.x, p.y, p.z) + low_, query_.z_up);
            if (!same)
                c = glm::ivec3(glm::round((placement_.voxel * glm::dvec3(c) + placement_.origin - own.origin) /
                                          own.voxel));
            const auto& value = values.getValue({c.x, c.y, c.z});
            if (!finite(value))
                reader_.refuse(name + ": voxel " + printed({c.x, c.y, c.z}), "no finite number", "one");
            take(i, value);
        }
    }

    void read_vectors(const char* name, std::vector<glm::vec3>& out) {
        const int index = reader_.find(name);
        if (index < 0)
            return;
        out.resize(out_.at.size());
        sample<Vec3SGrid>(index, [&](std::size_t i, const openvdb::Vec3f& v) { out[i] = {v.x(), v.y(), v.z()}; });
    }
    void read_scalars(const char* name, std::vector<float>& out) {
        const int index = reader_.find(name);
        if (index < 0)
            return;
        out.resize(out_.at.size());
        sample<FloatGrid>(index, [&](std::size_t i, float v) { out[i] = v; });
    }

    VdbReader& reader_;
    const VolumeQuery& query_;
    Placement placement_;
    glm::ivec3 low_{0}, shift_{0}; ///< our coordinates = file's, turned, - low_
    Volume out_;
};

} // namespace

VdbFile::VdbFile(std::span<const std::byte> bytes, std::filesystem::path name)
    : reader_(std::make_unique<VdbReader>(bytes, std::move(name))) {
    for (const openvdb::io::GridDescriptor& grid : reader_->table())
        infos_.push_back({grid.gridName(), grid.gridType()});
}
VdbFile::~VdbFile() = default;

Volume VdbFile::read_volume(const VolumeQuery& query) const {
    return VolumeReading(*reader_, query).run();
}

VdbCells VdbFile::read_cells() const {
    VdbReader& reader = *reader_;
    int key = reader.find("density");
    for (std::size_t i = 0; key < 0 && i < reader.size(); ++i)
        if (VdbReader::is_scalar(reader.table()[i]))
            key = static_cast<int>(i);
    if (key < 0)
        reader.refuse("grids", "no grid of floats", "a fog volume");
    const openvdb::GridBase::Ptr base = reader.load(key);
    const auto density = openvdb::gridPtrCast<FloatGrid>(base);
    if (!density)
        reader.refuse("grid " + base::printable(base->getName()), base->valueType(), "single floats");
    VdbCells out;
    out.key_grid = density->getName();
    const auto voxel = density->voxelSize();
    out.voxel = {voxel.x(), voxel.y(), voxel.z()};
    if (const auto m = density->getMetadata<openvdb::FloatMetadata>(kPeriodKey))
        out.period = m->value();
    for_active(*density, [&](const Coord& c, float value) {
        if (!finite(value))
            reader.refuse("grid " + out.key_grid + ": voxel " + printed(c), "no finite number", "one");
        out.at.push_back(vec(c));
        out.key.push_back(value);
    });
    std::vector<glm::ivec3> others;
    const auto note = [&](const auto& grid) {
        if (grid.transform() != density->transform())
            reader.refuse("grid " + base::printable(grid.getName()) + ": transform", "another than " + out.key_grid,
                          "the same voxels: resample the volume");
        const auto on = density->getConstAccessor();
        for_active(grid, [&](const Coord& c, const auto& value) {
            if (!finite(value))
                reader.refuse("grid " + base::printable(grid.getName()) + ": voxel " + printed(c), "no finite number", "one");
            if (!on.isValueOn(c))
                others.push_back(vec(c));
        });
    };
    for (std::size_t i = 0; i < reader.size(); ++i) {
        const auto& entry = reader.table()[i];
        if (static_cast<int>(i) == key || !(VdbReader::is_scalar(entry) || VdbReader::is_vector(entry)))
            continue;
        const openvdb::GridBase::Ptr grid = reader.load(static_cast<int>(i));
        if (VdbReader::is_scalar(entry))
            note(static_cast<const FloatGrid&>(*grid));
        else
            note(static_cast<const Vec3SGrid&>(*grid));
    }
    const auto before = [](const glm::ivec3& a, const glm::ivec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::sort(others.begin(), others.end(), before);
    others.erase(std::unique(others.begin(), others.end()), others.end());
    out.at.insert(out.at.end(), others.begin(), others.end());
    out.key.resize(out.at.size(), 0);
    return out;
}

std::vector<std::byte> VdbFile::moved(std::span<const VdbMove> moves, double period) const {
    openvdb::GridPtrVec grids;
    const auto move_all = [&](const auto& grid) {
        const auto out = grid.copyWithNewTree();
        auto to = out->getAccessor();
        const auto from = grid.getConstAccessor();
        for (const VdbMove& m : moves) {
            const Coord c(m.from.x, m.from.y, m.from.z);
            if (from.isValueOn(c))
                to.setValue({m.to.x, m.to.y, m.to.z}, from.getValue(c));
        }
        out->insertMeta(kPeriodKey, openvdb::FloatMetadata(static_cast<float>(period)));
        grids.push_back(out);
    };
    for (std::size_t i = 0; i < reader_->size(); ++i) {
        const auto& entry = reader_->table()[i];
        if (!VdbReader::is_scalar(entry) && !VdbReader::is_vector(entry)) {
            base::log_warning(fmt::format("grid {} of type {} is left out", base::printable(entry.gridName()),
                                          base::printable(entry.gridType())));
            continue;
        }
        const openvdb::GridBase::Ptr grid = reader_->load(static_cast<int>(i));
        if (VdbReader::is_scalar(entry))
            move_all(static_cast<const FloatGrid&>(*grid));
        else
            move_all(static_cast<const Vec3SGrid&>(*grid));
    }
    return encode_grids(grids);
}

} // namespace sward::texgen
