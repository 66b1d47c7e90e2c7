// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/vdb_file.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/vdb/vdb_reader.h"
#include "texgen/vdb/vdb_writer.h"
#include "texgen/vdb/volume_light.h"

namespace sward::texgen {
namespace {

constexpr float kLeastDensity = 1e-12f; // denormals and the like

bool is_rounded_zero(float v) {
    return v != 0 && v < kLeastDensity;
}

/// Index to world of a grid that only scales (alike on all axes) and shifts.
struct Placement {
    double voxel = 0;
    glm::dvec3 origin{0};
    [[nodiscard]] bool on(const Placement& o) const {
        return std::abs(voxel - o.voxel) < 1e-4 * voxel &&
               glm::length(origin - o.origin) < 1e-2 * voxel;
    }
};

/// Below 0 by rounding: a part of the largest value. What lies further below is no fog.
constexpr float kRoundedBelow = 1e-3f;

std::string printed(const glm::ivec3& c) {
    return fmt::format("({}, {}, {})", c.x, c.y, c.z);
}

std::string shown(const SparseGrid& grid) {
    return "grid " + base::printable(grid.name);
}

bool finite(const float* v, int components) {
    return std::all_of(v, v + components, [](float x) { return std::isfinite(x); });
}

/// Least density that is not taken for 0; refuses what no fog can hold.
void check_density(const VdbReader& reader, const SparseGrid& grid) {
    if (grid.is_level_set())
        reader.refuse(shown(grid), "a level set (distances)",
                      "a fog volume: convert it (Houdini: Convert VDB; Blender: Mesh to Volume)");
    float most = 0;
    grid.for_active([&](const glm::ivec3&, const float* v) { most = std::max(most, *v); });
    std::size_t rounded = 0;
    grid.for_active([&](const glm::ivec3& at, const float* v) {
        if (!std::isfinite(*v) || *v < -kRoundedBelow * most)
            reader.refuse(shown(grid) + ": voxel " + printed(at), fmt::format("{}", *v),
                          "0 or more (a level set?)");
        rounded += is_rounded_zero(*v) ? 1 : 0;
    });
    if (rounded > 0)
        base::log_warning(
            fmt::format("{}: {}: {} voxels of a tiny or slightly negative density are taken as 0",
                        reader.file(), shown(grid), rounded));
}

/// A voxel of the density on its way to its order.
struct Found {
    std::uint64_t key = 0; ///< y, z, x, 16 bits each
    float density = 0;
};

/// The file's axes to ours: z up becomes y up by a quarter turn about x.
glm::ivec3 turned(glm::ivec3 v, bool z_up) {
    return z_up ? glm::ivec3(v.x, v.z, -v.y) : v;
}
glm::ivec3 turned_back(glm::ivec3 v, bool z_up) {
    return z_up ? glm::ivec3(v.x, -v.z, v.y) : v;
}

/// The steps of read_volume.
class VolumeReading {
public:
    VolumeReading(VdbReader& reader, const VolumeQuery& query) : reader_(reader), query_(query) {}

    Volume run() {
        read_density();
        if (!query_.companions)
            return std::move(out_);
        read_vectors({"tangent"}, out_.tangent);
        for (glm::vec3& t : out_.tangent) {
            if (query_.z_up)
                t = {t.x, t.z, -t.y};
            const float length = glm::length(t);
            t = length > 1e-6f ? t / length : glm::vec3(0, 1, 0);
        }
        read_vectors({"colour", "color", "Cd"}, out_.colour);
        read_scalars("rank", out_.rank);
        read_scalars("seed", out_.seed);
        if (out_.format_version > 0) // a grid of that name elsewhere may be anything
            read_scalars("others", out_.others);
        return std::move(out_);
    }

private:
    Placement placement_of(const SparseGrid& grid) const {
        const VdbTransform& m = grid.transform;
        const Placement p{m.at(0, 0), {m.at(3, 0), m.at(3, 1), m.at(3, 2)}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (!(std::abs(m.at(i, j) - (i == j ? p.voxel : 0)) <= 1e-4 * p.voxel))
                    reader_.refuse(shown(grid) + ": transform", "a turn, a shear or unequal axes",
                                   "cubic voxels along the axes: resample the volume");
        return p;
    }

    void read_density() {
        const int index = reader_.find("density");
        if (index < 0)
            reader_.refuse("grids", "no \"density\"", "a fog volume of that name");
        const SparseGrid grid = reader_.load(index);
        if (grid.components != 1)
            reader_.refuse(shown(grid), "vectors of three", "single floats");
        check_density(reader_, grid);
        placement_ = placement_of(grid);
        std::vector<Found> found;
        collect(grid, found);
        read_head(grid);
        place(found);
    }

    void collect(const SparseGrid& grid, std::vector<Found>& found) {
        low_ = glm::ivec3(INT_MAX);
        glm::ivec3 high(INT_MIN);
        std::size_t count = 0;
        grid.for_active([&](const glm::ivec3& c, const float* value) {
            if (!(*value >= kLeastDensity))
                return;
            const glm::ivec3 at = turned(c, query_.z_up);
            low_ = glm::min(low_, at);
            high = glm::max(high, at);
            ++count;
        });
        if (count == 0)
            reader_.refuse(shown(grid), "no voxel above 0", "some grass");
        out_.cells = high - low_ + 1;
        found.reserve(count);
        grid.for_active([&](const glm::ivec3& c, const float* value) {
            if (!(*value >= kLeastDensity))
                return;
            const glm::u64vec3 k(turned(c, query_.z_up) - low_);
            found.push_back({k.y << 32 | k.z << 16 | k.x, *value});
        });
        std::ranges::sort(found, {}, &Found::key);
    }

    void read_head(const SparseGrid& grid) {
        out_.voxel_m = placement_.voxel * query_.scale;
        float period_m = 0;
        if (grid.read_meta(kPeriodKey, "float", period_m))
            out_.period_m = static_cast<double>(period_m) * query_.scale;
        // Light fades from the canopy's top down: half a voxel is 3 % of it in a lawn. What is not
        // of this box says nothing.
        float canopy_m = 0;
        if (grid.read_meta(kCanopyKey, "float", canopy_m) &&
            std::abs(canopy_m * query_.scale / out_.voxel_m - out_.cells.y) < 1)
            out_.canopy_m = canopy_m * query_.scale;
        std::int32_t version = 0;
        if (grid.read_meta("format_version", "int32", version))
            out_.format_version = version;
        std::int64_t seed = 0;
        if (grid.read_meta("seed", "int64", seed))
            out_.set_seed = static_cast<std::uint64_t>(seed);
        if (out_.format_version > 0)
            out_.preset = grid.text_meta("preset").substr(0, 64);
        out_.light = read_light(reader_, grid);
        if (query_.period_m > 0)
            out_.period_m = query_.period_m;
        set_period();
    }

    void set_period() {
        const double period = out_.period_m / out_.voxel_m;
        const auto whole = static_cast<int>(std::lround(std::clamp(period, 0.0, 1e6)));
        if (!(std::abs(period - whole) < 0.01) || whole > kMaxVdbSide ||
            whole < std::max(out_.cells.x, out_.cells.z)) {
            if (query_.period_m > 0)
                throw base::Error(base::ExitCode::kUsage,
                                  fmt::format("--period: found {} m, expected a whole number of "
                                              "the volume's voxels of {:.6g} m: {} to {}",
                                              query_.period_m, out_.voxel_m,
                                              std::max(out_.cells.x, out_.cells.z), kMaxVdbSide));
            if (out_.period_m != 0)
                base::log_warning(
                    fmt::format("{} {} is not a whole number of voxels that holds the volume: "
                                "it is not used",
                                kPeriodKey, out_.period_m));
            out_.period_m = 0;
            return;
        }
        // A volume that lies inside its period keeps its place.
        const glm::ivec3 high = low_ + out_.cells;
        shift_ = glm::ivec3(low_.x >= 0 && high.x <= whole ? low_.x : 0, 0,
                            low_.z >= 0 && high.z <= whole ? low_.z : 0);
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

    /// take(i, value) with the grid's value at every voxel of the density: the nearest where their
    /// voxels differ.
    template<typename Take> void sample(int index, int components, const Take& take) {
        const SparseGrid grid = reader_.load(index);
        if (grid.components != components)
            reader_.refuse(shown(grid), grid.components == 1 ? "single floats" : "vectors of three",
                           components == 1 ? "single floats" : "vectors of three");
        const Placement own = placement_of(grid);
        const bool same = own.on(placement_);
        std::size_t hint = 0;
        for (std::size_t i = 0; i < out_.at.size(); ++i) {
            const VoxelPlace& p = out_.at[i];
            glm::ivec3 c = turned_back(glm::ivec3(p.x, p.y, p.z) + low_, query_.z_up);
            if (!same) {
                const glm::dvec3 there =
                    (placement_.voxel * glm::dvec3(c) + placement_.origin - own.origin) / own.voxel;
                c = glm::ivec3(glm::round(glm::clamp(there, -1e9, 1e9)));
            }
            const float* value = grid.at(c, hint).at;
            if (!finite(value, components))
                reader_.refuse(shown(grid) + ": voxel " + printed(c), "no finite number", "one");
            take(i, value);
        }
    }

    void read_vectors(std::initializer_list<const char*> names, std::vector<glm::vec3>& out) {
        for (const char* name : names)
            if (const int index = reader_.find(name); index >= 0) {
                out.resize(out_.at.size());
                return sample(index, 3, [&](std::size_t i, const float* v) {
                    out[i] = {v[0], v[1], v[2]};
                });
            }
    }
    void read_scalars(const char* name, std::vector<float>& out) {
        const int index = reader_.find(name);
        if (index < 0)
            return;
        out.resize(out_.at.size());
        sample(index, 1, [&](std::size_t i, const float* v) { out[i] = *v; });
    }

    VdbReader& reader_;
    const VolumeQuery& query_;
    Placement placement_;
    glm::ivec3 low_{0}, shift_{0}; ///< our coordinates = file's, turned, - low_
    Volume out_;
};

/// The voxels of `grid` that `key` has not, into `others`.
void note_others(const VdbReader& reader, const SparseGrid& grid, const SparseGrid& key,
                 std::vector<glm::ivec3>& others) {
    if (!grid.transform.near(key.transform))
        reader.refuse(shown(grid) + ": transform", "another than " + base::printable(key.name),
                      "the same voxels: resample the volume");
    if (grid.is_level_set())
        reader.refuse(shown(grid), "a level set (distances)", "a fog volume");
    std::size_t hint = 0;
    grid.for_active([&](const glm::ivec3& c, const float* value) {
        if (!finite(value, grid.components))
            reader.refuse(shown(grid) + ": voxel " + printed(c), "no finite number", "one");
        if (!key.at(c, hint).active)
            others.push_back(c);
    });
}

/// The grid that decides between two voxels.
int key_of(const VdbReader& reader) {
    if (const int density = reader.find("density"); density >= 0)
        return density;
    const auto scalar = std::ranges::find_if(reader.table(), &VdbEntry::is_scalar);
    if (scalar == reader.table().end())
        reader.refuse("grids", "no grid of floats", "a fog volume");
    return static_cast<int>(scalar - reader.table().begin());
}

} // namespace

std::vector<std::byte> read_vdb_file(const std::filesystem::path& path) {
    // A large file of another kind is told by its first bytes.
    const std::vector<std::byte> head = base::read_head(path, 8);
    if (head.size() < 8 || std::memcmp(head.data(), " BDV\0\0\0\0", 8) != 0)
        throw base::input_error(base::ExitCode::kBadInput, path, 0, "format", "something else",
                                "an OpenVDB file");
    return base::read_file(path, kMaxVdbBytes);
}

VdbFile::VdbFile(std::span<const std::byte> bytes, std::filesystem::path name)
    : reader_(std::make_unique<VdbReader>(bytes, std::move(name))) {
    for (const VdbEntry& grid : reader_->table())
        infos_.push_back({grid.name, grid.type});
}
VdbFile::~VdbFile() = default;

void VdbFile::check_grids() const {
    for (std::size_t i = 0; i < reader_->table().size(); ++i)
        if (const VdbEntry& entry = reader_->table()[i];
            !entry.instance && (entry.is_scalar() || entry.is_vector()))
            (void)reader_->load(static_cast<int>(i));
}

Volume VdbFile::read_volume(const VolumeQuery& query) const {
    return VolumeReading(*reader_, query).run();
}

VdbCells VdbFile::read_cells() const {
    VdbReader& reader = *reader_;
    const int index = key_of(reader);
    const SparseGrid key = reader.load(index);
    if (key.components != 1)
        reader.refuse(shown(key), "vectors of three", "single floats");
    if (key.name == "density" || key.is_level_set())
        check_density(reader, key);
    VdbCells out;
    out.key_grid = key.name;
    out.voxel = {key.transform.voxel(0), key.transform.voxel(1), key.transform.voxel(2)};
    float period = 0;
    if (key.read_meta(kPeriodKey, "float", period))
        out.period = period;
    key.for_active([&](const glm::ivec3& c, const float* value) {
        if (!std::isfinite(*value))
            reader.refuse(shown(key) + ": voxel " + printed(c), "no finite number", "one");
        out.at.push_back(c);
        out.key.push_back(*value);
    });
    std::vector<glm::ivec3> others;
    for (std::size_t i = 0; i < reader.table().size(); ++i) {
        const VdbEntry& entry = reader.table()[i];
        if (static_cast<int>(i) != index && (entry.is_scalar() || entry.is_vector()))
            note_others(reader, reader.load(static_cast<int>(i)), key, others);
    }
    const auto place = [](const glm::ivec3& a) { return std::tuple(a.x, a.y, a.z); };
    std::ranges::sort(others, {}, place);
    others.erase(std::ranges::unique(others).begin(), others.end());
    out.at.insert(out.at.end(), others.begin(), others.end());
    out.key.resize(out.at.size(), 0);
    return out;
}

std::vector<std::byte> VdbFile::moved(std::span<const VdbMove> moves, double period) const {
    VdbBuilder builder;
    for (std::size_t i = 0; i < reader_->table().size(); ++i) {
        const VdbEntry& entry = reader_->table()[i];
        if (entry.is_scalar() || entry.is_vector())
            builder.add_moved(reader_->load(static_cast<int>(i)), moves, period);
        else
            base::log_warning(fmt::format("grid {} of type {} is left out",
                                          base::printable(entry.name),
                                          base::printable(entry.type)));
    }
    return builder.bytes();
}

} // namespace sward::texgen
