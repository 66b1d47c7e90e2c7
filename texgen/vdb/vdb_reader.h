// SPDX-License-Identifier: Apache-2.0
// The bytes of an OpenVDB file, read by us: every length, count and offset is held against what is
// left of the file, and against the limits, before anything is taken or unpacked.
#pragma once

#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "texgen/vdb/vdb_grid.h"

namespace sward::texgen {

/// A place in the file. Reads past the end throw base::Error(kBadInput) that names it.
class VdbCursor {
public:
    VdbCursor(std::span<const std::byte> bytes, std::filesystem::path name)
        : name_(std::move(name)), bytes_(bytes) {}

    [[nodiscard]] std::uint64_t at() const { return at_; }
    [[nodiscard]] std::uint64_t left() const { return bytes_.size() - at_; }
    [[nodiscard]] const std::filesystem::path& name() const { return name_; }
    void seek(std::uint64_t place);
    [[nodiscard]] std::span<const std::byte> take(std::uint64_t count);
    template<typename T> [[nodiscard]] T number() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// 32 bits of length and the text.
    [[nodiscard]] std::string text();

    [[noreturn]] void refuse(const std::string& what, const std::string& found,
                             const std::string& expected) const;
    [[noreturn]] void over(const std::string& what, const std::string& found,
                           const std::string& expected) const;

private:
    std::filesystem::path name_;
    std::span<const std::byte> bytes_;
    std::uint64_t at_ = 0;
};

/// What the file's table says of a grid.
struct VdbEntry {
    std::string name; ///< as it stands: with the mark of a second grid of the name
    std::string type; ///< "Tree_float_5_4_3", without the mark of half floats
    bool half = false;
    bool instance = false; ///< of another grid's tree
    std::uint64_t grid_at = 0, block_at = 0, end_at = 0;

    [[nodiscard]] bool is_scalar() const { return type == "Tree_float_5_4_3"; }
    [[nodiscard]] bool is_vector() const { return type == "Tree_vec3s_5_4_3"; }
};

/// Parses the header and the table of grids, then reads one grid at a time.
class VdbReader {
public:
    VdbReader(std::span<const std::byte> bytes, std::filesystem::path name);

    [[nodiscard]] const std::vector<VdbEntry>& table() const { return table_; }
    /// Of the grid of that name, or -1.
    [[nodiscard]] int find(const std::string& name) const;

    /// Grid `index` with its voxels. Refuses other types than floats and vectors of three, and
    /// instances.
    [[nodiscard]] SparseGrid load(int index);

    [[nodiscard]] std::string file() const { return cursor_.name().string(); }
    [[noreturn]] void refuse(const std::string& what, const std::string& found,
                             const std::string& expected) const {
        cursor_.refuse(what, found, expected);
    }

private:
    void parse_header();
    void parse_table();
    [[nodiscard]] std::vector<VdbMeta> read_meta();
    [[nodiscard]] VdbTransform read_transform(const std::string& grid);
    [[nodiscard]] VdbTransform read_map(const std::string& grid);

    VdbCursor cursor_;
    std::vector<VdbEntry> table_;
};

/// Reads a grid's tree from where its nodes stand and, `block_at`, where its leaves' values do:
/// fills `grid`'s background, leaves, values and tiles. `packing`: the grid's compression flags.
void read_vdb_tree(VdbCursor& cursor, std::uint64_t block_at, std::uint32_t packing,
                   SparseGrid& grid);

} // namespace sward::texgen
