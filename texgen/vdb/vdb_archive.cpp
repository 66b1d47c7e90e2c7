// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/vdb_writer.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include "base/error.h"
#include "base/hash.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_grid.h"
#include "texgen/vdb/volume_light.h"

namespace sward::texgen {
namespace {

/// OpenVDB's writer onto a stream of our own.
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
    void name_by_content(std::string& text) const {
        const std::string tag = getUniqueTag();
        const std::size_t at = text.substr(0, 256).find(tag);
        if (at == std::string::npos || tag.size() != 36)
            throw base::Error(base::ExitCode::kFailure, "OpenVDB: no unique tag in the header");
        text.replace(at, tag.size(), tag.size(), '0');
        std::string named = base::sha256_hex(text).substr(0, 36);
        for (const std::size_t dash : {8, 13, 18, 23})
            named[dash] = '-';
        text.replace(at, named.size(), named);
    }
};

void label(openvdb::GridBase& grid, const Volume& volume) {
    const auto transform = openvdb::math::Transform::createLinearTransform(volume.voxel_m);
    transform->postTranslate(
        openvdb::Vec3d(volume.voxel_m / 2)); // a voxel's value stands at its middle
    grid.setTransform(transform);
    grid.setSaveFloatAsHalf(true);
    grid.setCreator("Sward texgen");
    grid.insertMeta(kPeriodKey, openvdb::FloatMetadata(static_cast<float>(volume.period_m)));
    if (volume.canopy_m > 0)
        grid.insertMeta(kCanopyKey, openvdb::FloatMetadata(static_cast<float>(volume.canopy_m)));
    grid.insertMeta("preset", openvdb::StringMetadata(volume.preset));
    grid.insertMeta("seed", openvdb::Int64Metadata(static_cast<std::int64_t>(volume.set_seed)));
    grid.insertMeta("format_version", openvdb::Int32Metadata(volume.format_version));
    grid.insertMeta(kLightVersionKey, openvdb::Int32Metadata(kLightVersion));
    for (const auto& [key, value] : light_terms(volume.light))
        grid.insertMeta(key, openvdb::FloatMetadata(value));
}

openvdb::GridBase::Ptr scalar_grid(const char* name, const Volume& volume,
                                   const std::vector<float>& values) {
    const auto grid = openvdb::FloatGrid::create(0);
    auto out = grid->getAccessor();
    for (std::size_t i = 0; i < values.size(); ++i)
        out.setValue({volume.at[i].x, volume.at[i].y, volume.at[i].z}, values[i]);
    grid->setName(name);
    label(*grid, volume);
    return grid;
}

openvdb::GridBase::Ptr vector_grid(const char* name, const Volume& volume,
                                   const std::vector<glm::vec3>& values, openvdb::VecType type) {
    const auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    auto out = grid->getAccessor();
    for (std::size_t i = 0; i < values.size(); ++i)
        out.setValue({volume.at[i].x, volume.at[i].y, volume.at[i].z},
                     openvdb::Vec3f(values[i].x, values[i].y, values[i].z));
    grid->setName(name);
    grid->setVectorType(type);
    label(*grid, volume);
    return grid;
}

/// The file's bytes, with the offsets that let tools read grid by grid (io::Stream leaves them out,
/// io::File writes past full disks). The random tag in the header becomes one of the content: equal
/// grids give equal bytes.
std::vector<std::byte> encode_grids(const openvdb::GridPtrVec& grids) {
    // OpenVDB counts with TBB, whose threads end the program where the system has none left.
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::string text = StreamArchive().bytes(grids);
    const auto* raw = reinterpret_cast<const std::byte*>(text.data());
    return {raw, raw + text.size()};
}

openvdb::math::Transform::Ptr transform_of(const VdbTransform& t) {
    using openvdb::math::Transform;
    const double voxel = t.at(0, 0);
    bool cubic = voxel > 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            cubic &= t.at(i, j) == (i == j ? voxel : 0.0);
    if (!cubic)
        return Transform::createLinearTransform(openvdb::Mat4d(t.m.data()));
    const auto out = Transform::createLinearTransform(voxel);
    out->postTranslate({t.at(3, 0), t.at(3, 1), t.at(3, 2)});
    return out;
}

/// The metadata as it stood; what does not fit its type is left out.
void copy_meta(const SparseGrid& from, openvdb::GridBase& to) {
    for (const VdbMeta& m : from.meta) {
        if (!openvdb::Metadata::isRegisteredType(m.type))
            continue;
        const std::string text(reinterpret_cast<const char*>(m.value.data()), m.value.size());
        if (m.type == openvdb::StringMetadata::staticTypeName()) {
            to.insertMeta(m.name, openvdb::StringMetadata(text));
            continue;
        }
        const openvdb::Metadata::Ptr value = openvdb::Metadata::createMetadata(m.type);
        if (value->size() != m.value.size())
            continue;
        const auto size = static_cast<std::uint32_t>(m.value.size());
        std::string sized(sizeof size, 0);
        std::memcpy(sized.data(), &size, sizeof size);
        std::istringstream stream(sized + text, std::ios::binary);
        value->read(stream);
        to.insertMeta(m.name, *value);
    }
}

/// A grid of the voxels that `moves` brings.
template<typename Grid, typename Value>
openvdb::GridBase::Ptr moved_grid(const SparseGrid& from, std::span<const VdbMove> moves,
                                  const Value& value_of) {
    const auto grid = Grid::create(value_of(from.background.data()));
    auto to = grid->getAccessor();
    std::size_t hint = 0;
    for (const VdbMove& m : moves)
        if (const SparseGrid::Value v = from.at(m.from, hint); v.active)
            to.setValue({m.to.x, m.to.y, m.to.z}, value_of(v.at));
    return grid;
}

} // namespace

std::vector<std::byte> encode_vdb(const Volume& volume) {
    openvdb::initialize();
    openvdb::GridPtrVec grids = {scalar_grid("density", volume, volume.density)};
    grids.front()->setGridClass(openvdb::GRID_FOG_VOLUME);
    // A direction turns with the object; a colour does not.
    if (!volume.tangent.empty())
        grids.push_back(
            vector_grid("tangent", volume, volume.tangent, openvdb::VEC_CONTRAVARIANT_RELATIVE));
    if (!volume.colour.empty())
        grids.push_back(vector_grid("colour", volume, volume.colour, openvdb::VEC_INVARIANT));
    if (!volume.rank.empty())
        grids.push_back(scalar_grid("rank", volume, volume.rank));
    if (!volume.seed.empty())
        grids.push_back(scalar_grid("seed", volume, volume.seed));
    if (!volume.others.empty())
        grids.push_back(scalar_grid("others", volume, volume.others));
    return encode_grids(grids);
}

struct VdbBuilder::State {
    openvdb::GridPtrVec grids;
};

VdbBuilder::VdbBuilder() : state_(std::make_unique<State>()) {
    openvdb::initialize();
}
VdbBuilder::~VdbBuilder() = default;

void VdbBuilder::add_moved(const SparseGrid& from, std::span<const VdbMove> moves, double period) {
    // What is below 0 by rounding is written as 0: a reader would have to ask what a negative
    // density means.
    const bool fog = from.name == "density";
    const openvdb::GridBase::Ptr grid =
        from.components == 1
            ? moved_grid<openvdb::FloatGrid>(
                  from, moves, [fog](const float* v) { return fog ? std::max(*v, 0.0f) : *v; })
            : moved_grid<openvdb::Vec3SGrid>(
                  from, moves, [](const float* v) { return openvdb::Vec3f(v[0], v[1], v[2]); });
    copy_meta(from, *grid);
    grid->setName(from.name);
    grid->setTransform(transform_of(from.transform));
    grid->setSaveFloatAsHalf(from.half);
    grid->insertMeta(kPeriodKey, openvdb::FloatMetadata(static_cast<float>(period)));
    state_->grids.push_back(grid);
}

std::vector<std::byte> VdbBuilder::bytes() const {
    return encode_grids(state_->grids);
}

} // namespace sward::texgen
