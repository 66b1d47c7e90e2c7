// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/vdb_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "texgen/vdb/vdb_file.h"

namespace sward::texgen {
namespace {

constexpr unsigned char kMagic[] = {0x20, 'B', 'D', 'V', 0, 0, 0, 0};
constexpr std::uint32_t kOldestVersion = 222; // masks of inactive values: OpenVDB 2.0 of 2013
constexpr std::uint64_t kUuidBytes = 36;
constexpr std::uint32_t kMaxMeta = 65536;
constexpr char kNameMark = '\x1e'; // before the number of a second grid of the name
constexpr std::string_view kHalfMark = "_HalfFloat";
constexpr double kLeastVolume =
    3e-15; // of a voxel: below it OpenVDB itself takes a transform for singular

std::string shown(const VdbEntry& entry) {
    return "grid " + base::printable(entry.name.substr(0, entry.name.find(kNameMark)));
}

VdbTransform scaled(const std::array<double, 3>& scale, const std::array<double, 3>& shift) {
    VdbTransform t;
    for (std::size_t i = 0; i < 3; ++i) {
        t.m[5 * i] = scale[i];
        t.m[12 + i] = shift[i];
    }
    t.m[15] = 1;
    return t;
}

} // namespace

void VdbCursor::refuse(const std::string& what, const std::string& found,
                       const std::string& expected) const {
    throw base::input_error(base::ExitCode::kBadInput, name_, 0, what, found, expected);
}
void VdbCursor::over(const std::string& what, const std::string& found,
                     const std::string& expected) const {
    throw base::input_error(base::ExitCode::kOverLimit, name_, 0, what, found, expected);
}

void VdbCursor::seek(std::uint64_t place) {
    if (place > bytes_.size())
        refuse("content", fmt::format("a place at byte {} of {}", place, bytes_.size()),
               "a whole OpenVDB file");
    at_ = place;
}

std::span<const std::byte> VdbCursor::take(std::uint64_t count) {
    if (count > left())
        refuse("content", fmt::format("{} bytes at byte {} of {}", count, at_, bytes_.size()),
               "a whole OpenVDB file");
    const std::span<const std::byte> out =
        bytes_.subspan(static_cast<std::size_t>(at_), static_cast<std::size_t>(count));
    at_ += count;
    return out;
}

std::string VdbCursor::text() {
    const std::span<const std::byte> letters = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(letters.data()), letters.size()};
}

VdbReader::VdbReader(std::span<const std::byte> bytes, std::filesystem::path name)
    : cursor_(bytes, std::move(name)) {
    if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
        refuse("format", "something else", "an OpenVDB file");
    cursor_.seek(sizeof kMagic);
    parse_header();
    parse_table();
}

void VdbReader::parse_header() {
    const auto version = cursor_.number<std::uint32_t>();
    if (version < kOldestVersion)
        refuse("file version", std::to_string(version),
               fmt::format("{} or later: save it with OpenVDB 2 or later", kOldestVersion));
    (void)cursor_.take(8); // the library's version
    if (cursor_.number<std::uint8_t>() == 0)
        refuse("header", "a stream without offsets", "a file that OpenVDB's io::File wrote");
    (void)cursor_.take(kUuidBytes);
    (void)read_meta(); // the file's own
}

void VdbReader::parse_table() {
    const auto count = cursor_.number<std::int32_t>();
    if (count < 1)
        refuse("grids", std::to_string(count), "at least one");
    if (count > kMaxVdbGrids)
        cursor_.over("grids", std::to_string(count), fmt::format("at most {}", kMaxVdbGrids));
    for (std::int32_t i = 0; i < count; ++i) {
        VdbEntry entry;
        entry.name = cursor_.text();
        entry.type = cursor_.text();
        if (entry.type.ends_with(kHalfMark)) {
            entry.half = true;
            entry.type.resize(entry.type.size() - kHalfMark.size());
        }
        entry.instance = !cursor_.text().empty();
        entry.grid_at = cursor_.number<std::uint64_t>();
        entry.block_at = cursor_.number<std::uint64_t>();
        entry.end_at = cursor_.number<std::uint64_t>();
        if (entry.grid_at < cursor_.at() || entry.block_at < entry.grid_at ||
            entry.end_at < entry.block_at)
            refuse(shown(entry) + ": offsets",
                   fmt::format("{}, {}, {}", entry.grid_at, entry.block_at, entry.end_at),
                   "rising numbers");
        cursor_.seek(entry.end_at);
        table_.push_back(std::move(entry));
    }
}

int VdbReader::find(const std::string& name) const {
    const auto found = std::ranges::find(table_, name, &VdbEntry::name);
    return found == table_.end() ? -1 : static_cast<int>(found - table_.begin());
}

std::vector<VdbMeta> VdbReader::read_meta() {
    const auto count = cursor_.number<std::uint32_t>();
    if (count > kMaxMeta)
        refuse("metadata", fmt::format("{} entries", count), fmt::format("at most {}", kMaxMeta));
    std::vector<VdbMeta> out;
    for (std::uint32_t i = 0; i < count; ++i) {
        VdbMeta m;
        m.name = cursor_.text();
        m.type = cursor_.text();
        const std::span<const std::byte> value = cursor_.take(cursor_.number<std::uint32_t>());
        m.value.assign(value.begin(), value.end());
        out.push_back(std::move(m));
    }
    return out;
}

VdbTransform VdbReader::read_map(const std::string& grid) {
    const std::string type = cursor_.text();
    const auto three = [&] {
        return std::array{cursor_.number<double>(), cursor_.number<double>(),
                          cursor_.number<double>()};
    };
    const auto skip = [&](int vectors) {
        (void)cursor_.take(static_cast<std::uint64_t>(vectors) * 24);
    }; // what follows from the scale
    if (type == "UniformScaleMap" || type == "ScaleMap") {
        const auto scale = three();
        skip(4);
        return scaled(scale, {});
    }
    if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
        const auto shift = three();
        const auto scale = three();
        skip(4);
        return scaled(scale, shift);
    }
    if (type == "TranslationMap")
        return scaled({1, 1, 1}, three());
    if (type != "AffineMap" && type != "UnitaryMap")
        refuse(grid + ": transform",
               type == "NonlinearFrustumMap" ? "a frustum" : base::printable(type),
               "a scale and a shift");
    VdbTransform t;
    for (double& v : t.m)
        v = cursor_.number<double>();
    return t;
}

VdbTransform VdbReader::read_transform(const std::string& grid) {
    const VdbTransform t = read_map(grid);
    bool finite = true;
    for (const double v : t.m)
        finite &= std::isfinite(v) && std::abs(v) < 1e18;
    if (!finite || !(std::abs(t.determinant()) >= kLeastVolume))
        refuse(grid + ": transform",
               finite ? fmt::format("voxels of {} x {} x {}, nearly flat", t.voxel(0), t.voxel(1),
                                    t.voxel(2))
                      : "no finite number",
               "voxels with a volume, 0.00002 units wide or more");
    return t;
}

SparseGrid VdbReader::load(int index) {
    const VdbEntry& entry = table_[static_cast<std::size_t>(index)];
    const std::string name = shown(entry);
    if (entry.instance)
        refuse(name, "an instance of another grid's tree",
               "a tree of its own: save without instancing");
    if (!entry.is_scalar() && !entry.is_vector())
        refuse(name, base::printable(entry.type), "single floats or vectors of three");
    SparseGrid grid;
    grid.name = entry.name.substr(0, entry.name.find(kNameMark));
    grid.components = entry.is_vector() ? 3 : 1;
    grid.half = entry.half;
    cursor_.seek(entry.grid_at);
    const auto packing = cursor_.number<std::uint32_t>();
    grid.meta = read_meta();
    std::erase_if(grid.meta, [](const VdbMeta& m) {
        return m.name.starts_with("file_");
    }); // of that very file
    grid.transform = read_transform(name);
    read_vdb_tree(cursor_, entry.block_at, packing, grid);
    if (cursor_.at() != entry.end_at)
        refuse(name, fmt::format("values that end at byte {}", cursor_.at()),
               fmt::format("byte {}, as the table of grids says", entry.end_at));
    return grid;
}

} // namespace sward::texgen
