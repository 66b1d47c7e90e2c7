// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb_writer.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "texgen/vdb_file.h"
#include "texgen/vdb_reader.h"

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
    transform->postTranslate(openvdb::Vec3d(volume.voxel_m / 2)); // a voxel's value stands at its middle
    grid.setTransform(transform);
    grid.setSaveFloatAsHalf(true);
    grid.setCreator("Sward texgen");
    grid.insertMeta("period_m", openvdb::FloatMetadata(static_cast<float>(volume.period_m)));
    grid.insertMeta("preset", openvdb::StringMetadata(volume.preset));
    grid.insertMeta("seed", openvdb::Int64Metadata(static_cast<std::int64_t>(volume.set_seed)));
    grid.insertMeta("format_version", openvdb::Int32Metadata(volume.format_version));
}

openvdb::GridBase::Ptr scalar_grid(const char* name, const Volume& volume, const std::vector<float>& values) {
    const auto grid = openvdb::FloatGrid::create(0);
    auto out = grid->getAccessor();
    for (std::size_t i = 0; i < values.size(); ++i)
        out.setValue({volume.at[i].x, volume.at[i].y, volume.at[i].z}, values[i]);
    grid->setName(name);
    label(*grid, volume);
    return grid;
}

openvdb::GridBase::Ptr vector_grid(const char* name, const Volume& volume, const std::vector<glm::vec3>& values,
                                   openvdb::VecType type) {
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

} // namespace

// ---- Writing ----

std::vector<std::byte> encode_grids(const openvdb::GridPtrVec& grids) {
    const std::string text = StreamArchive().bytes(grids);
    const auto* raw = reinterpret_cast<const std::byte*>(text.data());
    return {raw, raw + text.size()};
}

std::vector<std::byte> encode_vdb(const Volume& volume) {
    openvdb::initialize();
    openvdb::GridPtrVec grids = {scalar_grid("density", volume, volume.density)};
    grids.front()->setGridClass(openvdb::GRID_FOG_VOLUME);
    // A direction turns with the object; a colour does not.
    if (!volume.tangent.empty())
        grids.push_back(vector_grid("tangent", volume, volume.tangent, openvdb::VEC_CONTRAVARIANT_RELATIVE));
    if (!volume.colour.empty())
        grids.push_back(vector_grid("colour", volume, volume.colour, openvdb::VEC_INVARIANT));
    if (!volume.rank.empty())
        grids.push_back(scalar_grid("rank", volume, volume.rank));
    if (!volume.seed.empty())
        grids.push_back(scalar_grid("seed", volume, volume.seed));
    return encode_grids(grids);
}

// ---- Reading ----

VdbReader::VdbReader(std::span<const std::byte> bytes, std::filesystem::path name)
    : name_(std::move(name)), bytes_(static_cast<std::int64_t>(bytes.size())), buffer_(bytes), stream_(&buffer_) {
    static constexpr unsigned char kMagic[] = {0x20, 'B', 'D', 'V', 0, 0, 0, 0};
    if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
        refuse("format", "something else", "an OpenVDB file");
    openvdb::initialize();
    // A short read must not leave values as they were.
    stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    guarded([&] { parse_table(); });
}

void VdbReader::refuse(const std::string& what, const std::string& found, const std::string& expected) const {
    throw base::input_error(base::ExitCode::kBadInput, name_, 0, what, found, expected);
}
void VdbReader::over(const std::string& what, const std::string& found, const std::string& expected) const {
    throw base::input_error(base::ExitCode::kOverLimit, name_, 0, what, found, expected);
}

template<typename Act> void VdbReader::guarded(const Act& act) const {
    try {
        act();
    } catch (const base::Error&) {
        throw;
    } catch (const std::ios_base::failure&) {
        refuse("content", "an end before its time", "a whole OpenVDB file");
    } catch (const std::bad_alloc&) {
        over("content", "more than memory holds", "a smaller volume");
    } catch (const std::exception& error) {
        refuse("content", base::printable(error.what()), "a whole OpenVDB file");
    }
}

void VdbReader::parse_table() {
    readHeader(stream_);
    if (!inputHasGridOffsets())
        refuse("header", "a stream without offsets", "a file that OpenVDB's io::File wrote");
    state_.reset(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream_, state_, false);
    setFormatVersion(stream_);
    setLibraryVersion(stream_);
    setDataCompression(stream_);
    openvdb::MetaMap().readMeta(stream_);
    const std::int32_t count = readGridCount(stream_);
    if (count < 1)
        refuse("grids", std::to_string(count), "at least one");
    if (count > kMaxVdbGrids)
        over("grids", std::to_string(count), fmt::format("at most {}", kMaxVdbGrids));
    for (std::int32_t i = 0; i < count; ++i) {
        openvdb::io::GridDescriptor grid;
        try {
            grid.read(stream_);
        } catch (const openvdb::LookupError&) { // a type that this library does not know; its offsets come next
            std::int64_t offsets[3];
            stream_.read(reinterpret_cast<char*>(offsets), sizeof offsets);
            grid.setGridPos(offsets[0]);
            grid.setBlockPos(offsets[1]);
            grid.setEndPos(offsets[2]);
        }
        check(grid, stream_.tellg());
        table_.push_back(grid);
        grid.seekToEnd(stream_);
    }
}

void VdbReader::check(const openvdb::io::GridDescriptor& grid, std::int64_t from) const {
    const std::string name = "grid " + base::printable(grid.gridName());
    if (grid.getGridPos() < from || grid.getBlockPos() < grid.getGridPos() || grid.getEndPos() < grid.getBlockPos())
        refuse(name + ": offsets", fmt::format("{}, {}, {}", grid.getGridPos(), grid.getBlockPos(), grid.getEndPos()),
               "rising numbers");
    if (grid.getEndPos() > bytes_)
        refuse(name, fmt::format("an end at byte {} of {}", grid.getEndPos(), bytes_), "a whole file");
}

bool VdbReader::is_scalar(const openvdb::io::GridDescriptor& grid) {
    return grid.gridType() == openvdb::FloatGrid::gridType();
}
bool VdbReader::is_vector(const openvdb::io::GridDescriptor& grid) {
    return grid.gridType() == openvdb::Vec3SGrid::gridType();
}

int VdbReader::find(const std::string& name) const {
    for (std::size_t i = 0; i < table_.size(); ++i)
        if (table_[i].gridName() == name)
            return static_cast<int>(i);
    return -1;
}

openvdb::GridBase::Ptr VdbReader::load(int index) {
    const openvdb::io::GridDescriptor& entry = table_[static_cast<std::size_t>(index)];
    const std::string name = "grid " + base::printable(entry.gridName());
    if (entry.isInstance())
        refuse(name, "an instance of another grid's tree", "a tree of its own: save without instancing");
    if (!is_scalar(entry) && !is_vector(entry))
        refuse(name, base::printable(entry.gridType()), "single floats or vectors of three");
    const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(entry.gridType());
    grid->setName(entry.gridName());
    guarded([&] {
        stream_.clear();
        entry.seekToGrid(stream_);
        grid->setSaveFloatAsHalf(entry.saveFloatAsHalf());
        readGridCompression(stream_);
        grid->readMeta(stream_);
        grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
        state_->gridMetadata() = static_cast<openvdb::MetaMap&>(*grid);
        grid->readTransform(stream_);
        grid->readTopology(stream_);
        check_topology(*grid);
        grid->readBuffers(stream_);
    });
    grid->setName(openvdb::io::GridDescriptor::stripSuffix(entry.gridName()));
    return grid;
}

void VdbReader::check_topology(const openvdb::GridBase& grid) const {
    const std::string name = "grid " + base::printable(grid.getName());
    const std::uint64_t active = grid.activeVoxelCount();
    const std::uint64_t stored = std::uint64_t{grid.constBaseTree().leafCount()} * 512;
    if (std::max(active, stored) > kMaxVdbVoxels)
        over(name, fmt::format("{} voxels", std::max(active, stored)), fmt::format("at most {}", kMaxVdbVoxels));
    const openvdb::Coord size = grid.evalActiveVoxelBoundingBox().dim();
    if (active > 0 && std::max({size.x(), size.y(), size.z()}) > kMaxVdbSide)
        over(name, fmt::format("a box of {} x {} x {} voxels", size.x(), size.y(), size.z()),
             fmt::format("at most {} a side", kMaxVdbSide));
}

} // namespace sward::texgen
