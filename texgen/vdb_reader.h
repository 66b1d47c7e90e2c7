// SPDX-License-Identifier: Apache-2.0
// OpenVDB's side of VdbFile. For vdb_archive.cpp and vdb_file.cpp alone: OpenVDB is slow to compile, so no other file may
// include it.
#pragma once

#include <filesystem>
#include <istream>
#include <span>
#include <streambuf>
#include <string>
#include <vector>

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

namespace sward::texgen {

/// The file's bytes, with the offsets that let tools read grid by grid (io::Stream leaves them out, io::File writes
/// past full disks). The random tag in the header becomes one of the content: equal grids give equal bytes.
[[nodiscard]] std::vector<std::byte> encode_grids(const openvdb::GridPtrVec& grids);


/// Bytes as a stream buffer that seeks.
class ByteBuffer : public std::streambuf {
public:
    explicit ByteBuffer(std::span<const std::byte> bytes) {
        char* begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data())); // never written to
        setg(begin, begin, begin + bytes.size());
    }

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
        const off_type base = from == std::ios_base::beg   ? 0
                              : from == std::ios_base::cur ? gptr() - eback()
                                                           : egptr() - eback();
        return seekpos(base + offset, std::ios_base::in);
    }
    pos_type seekpos(pos_type place, std::ios_base::openmode) override {
        if (place < 0 || place > egptr() - eback())
            return pos_type(off_type(-1));
        setg(eback(), eback() + static_cast<off_type>(place), egptr());
        return place;
    }
};

/// Parses the header and the table of grids, then reads one grid at a time.
class VdbReader : private openvdb::io::Archive {
public:
    VdbReader(std::span<const std::byte> bytes, std::filesystem::path name);

    [[nodiscard]] const std::vector<openvdb::io::GridDescriptor>& table() const { return table_; }
    [[nodiscard]] std::size_t size() const { return table_.size(); }
    [[nodiscard]] static bool is_scalar(const openvdb::io::GridDescriptor& grid);
    [[nodiscard]] static bool is_vector(const openvdb::io::GridDescriptor& grid);
    /// Of the grid of that name, or -1.
    [[nodiscard]] int find(const std::string& name) const;

    /// Grid `index` with its voxels. Box and counts are checked before its values are read.
    [[nodiscard]] openvdb::GridBase::Ptr load(int index);

    [[noreturn]] void refuse(const std::string& what, const std::string& found,
                             const std::string& expected) const;
    [[noreturn]] void over(const std::string& what, const std::string& found,
                           const std::string& expected) const;

private:
    void parse_table();
    void check(const openvdb::io::GridDescriptor& grid, std::int64_t from) const;
    void check_topology(const openvdb::GridBase& grid) const;
    /// Runs `act`; what OpenVDB or the stream throws becomes a base::Error.
    template<typename Act> void guarded(const Act& act) const;

    std::filesystem::path name_;
    std::int64_t bytes_;
    ByteBuffer buffer_;
    std::istream stream_;
    openvdb::io::StreamMetadata::Ptr state_; // the stream points at this very pointer
    std::vector<openvdb::io::GridDescriptor> table_;
};

} // namespace sward::texgen
