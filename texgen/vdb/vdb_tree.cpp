// SPDX-License-Identifier: Apache-2.0
// The tree of a grid: a root, nodes of 32 and of 16 cells a side, leaves of 8 voxels. First come
// all nodes with their masks and tiles, then, in the same order, the leaves' values.
#include <algorithm>
#include <bit>
#include <climits>

#include <blosc.h>
#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <zlib.h>

#include "base/error.h"
#include "texgen/vdb/vdb_file.h"
#include "texgen/vdb/vdb_reader.h"

namespace sward::texgen {
namespace {

constexpr std::uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4; // flags of a grid's packing
constexpr int kRootSide = 4096, kMiddleSide = 128;
constexpr int kFarthest = 1 << 30; // a coordinate that sums cannot overflow from
constexpr std::size_t kMaxTiles = kMaxVdbVoxels / SparseGrid::kLeafVoxels;

/// What a node says of its inactive values.
enum Inactive : std::uint8_t {
    kBackground = 0,
    kMinusBackground = 1,
    kOneValue = 2,
    kMaskOfSigns = 3,
    kMaskAndOneValue = 4,
    kMaskAndTwoValues = 5,
    kAllStored = 6
};

/// A node's bits. Of cells (x * side + y) * side + z.
class Mask {
public:
    Mask(VdbCursor& cursor, int cells) : words_(static_cast<std::size_t>(cells) / 64) {
        const std::span<const std::byte> bytes = cursor.take(words_.size() * 8);
        std::memcpy(words_.data(), bytes.data(), bytes.size());
    }
    [[nodiscard]] bool on(int i) const {
        return words_[static_cast<std::size_t>(i) / 64] >> (i % 64) & 1;
    }
    [[nodiscard]] std::size_t count() const {
        std::size_t sum = 0;
        for (const std::uint64_t w : words_)
            sum += static_cast<std::size_t>(std::popcount(w));
        return sum;
    }
    [[nodiscard]] const std::vector<std::uint64_t>& words() const { return words_; }

private:
    std::vector<std::uint64_t> words_;
};

class TreeReading {
public:
    TreeReading(VdbCursor& cursor, std::uint32_t packing, SparseGrid& grid)
        : cursor_(cursor), packing_(packing), grid_(grid),
          name_("grid " + base::printable(grid.name)),
          components_(static_cast<std::size_t>(grid.components)) {}

    void topology() {
        if (cursor_.number<std::int32_t>() != 1)
            refuse("buffers", "several", "one");
        grid_.background = value();
        const auto tiles = cursor_.number<std::uint32_t>(),
                   children = cursor_.number<std::uint32_t>();
        for (std::uint32_t i = 0; i < tiles; ++i) {
            const glm::ivec3 origin = root_cell();
            const std::array<float, 3> v = value();
            add_tile(origin, kRootSide, v.data(), cursor_.number<std::uint8_t>() != 0);
        }
        std::vector<std::array<int, 3>> seen; // a second child of a place would hide the first
        for (std::uint32_t i = 0; i < children; ++i) {
            const glm::ivec3 origin = root_cell();
            seen.push_back({origin.x, origin.y, origin.z});
            node(origin, kRootSide);
        }
        std::ranges::sort(seen);
        if (std::ranges::adjacent_find(seen) != seen.end() || !grid_.index())
            refuse("nodes", "two in one place", "a tree");
        check_box();
    }

    void leaf_values() {
        grid_.values.resize(grid_.leaves.size() * SparseGrid::kLeafVoxels * components_);
        float* out = grid_.values.data();
        for (const SparseGrid::Leaf& leaf : grid_.leaves) {
            const Mask mask(cursor_, SparseGrid::kLeafVoxels);
            if (!std::ranges::equal(mask.words(), leaf.on))
                refuse("a leaf", "voxels that its node does not name", "the same ones");
            values(mask, SparseGrid::kLeafVoxels, out);
            out += SparseGrid::kLeafVoxels * components_;
        }
    }

private:
    [[noreturn]] void refuse(const char* what, const std::string& found,
                             const char* expected) const {
        cursor_.refuse(fmt::format("{}: {}", name_, what), found, expected);
    }

    std::array<float, 3> value() {
        std::array<float, 3> v{};
        for (std::size_t c = 0; c < components_; ++c)
            v[c] = cursor_.number<float>();
        return v;
    }

    glm::ivec3 root_cell() {
        const int x = cursor_.number<std::int32_t>(), y = cursor_.number<std::int32_t>(),
                  z = cursor_.number<std::int32_t>();
        for (const int i : {x, y, z})
            if (i % kRootSide != 0 || i <= -kFarthest || i >= kFarthest)
                refuse("a node", fmt::format("at ({}, {}, {})", x, y, z),
                       "a multiple of 4096 below 2^30");
        return {x, y, z};
    }

    void add_tile(const glm::ivec3& origin, int side, const float* v, bool active) {
        if (!active && std::equal(v, v + components_, grid_.background.begin()))
            return;
        if (grid_.tiles.size() >= kMaxTiles)
            cursor_.over(name_, "more tiles", fmt::format("at most {}", kMaxTiles));
        SparseGrid::Tile tile{origin, side, active, {}};
        std::copy_n(v, components_, tile.value.begin());
        grid_.tiles.push_back(tile);
        if (active)
            count(static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) *
                  static_cast<std::uint64_t>(side));
    }

    void count(std::uint64_t voxels) {
        active_ += voxels;
        const std::uint64_t stored = std::uint64_t{grid_.leaves.size()} * SparseGrid::kLeafVoxels;
        if (std::max(active_, stored) > kMaxVdbVoxels)
            cursor_.over(name_, fmt::format("{} voxels or more", std::max(active_, stored)),
                         fmt::format("at most {}", kMaxVdbVoxels));
    }

    /// An inner node of `side` voxels.
    void node(const glm::ivec3& origin, int side) {
        const int cells_a_side = side == kRootSide ? 32 : 16, cell = side / cells_a_side;
        const int cells = cells_a_side * cells_a_side * cells_a_side;
        const Mask children(cursor_, cells), on(cursor_, cells);
        const auto place = [&](int i) {
            return origin + cell * glm::ivec3(i / (cells_a_side * cells_a_side),
                                              i / cells_a_side % cells_a_side, i % cells_a_side);
        };
        std::vector<float> tiles(static_cast<std::size_t>(cells) * components_);
        values(on, cells, tiles.data());
        for (int i = 0; i < cells; ++i)
            if (!children.on(i))
                add_tile(place(i), cell, &tiles[static_cast<std::size_t>(i) * components_],
                         on.on(i));
        tiles = {};
        for (int i = 0; i < cells; ++i)
            if (children.on(i) && cell == kMiddleSide)
                node(place(i), cell);
            else if (children.on(i))
                leaf(place(i));
    }

    void leaf(const glm::ivec3& origin) {
        const Mask mask(cursor_, SparseGrid::kLeafVoxels);
        SparseGrid::Leaf leaf{origin, {}};
        std::ranges::copy(mask.words(), leaf.on.begin());
        grid_.leaves.push_back(leaf);
        count(mask.count());
    }

    /// The values of a node's cells. Inactive ones may be left out of the file: one or two values
    /// and a mask stand for them.
    void values(const Mask& on, int cells, float* out) {
        const auto kind = cursor_.number<std::uint8_t>();
        if (kind > kAllStored)
            refuse("a node", fmt::format("values of kind {}", kind), "0 to 6");
        std::array<float, 3> first = grid_.background, second = grid_.background;
        if (kind != kBackground)
            for (float& v : first)
                v = -v;
        if (kind == kOneValue || kind == kMaskAndOneValue || kind == kMaskAndTwoValues)
            first = value();
        if (kind == kMaskAndTwoValues)
            second = value();
        const bool chosen =
            kind == kMaskOfSigns || kind == kMaskAndOneValue || kind == kMaskAndTwoValues;
        std::vector<Mask> choice;
        if (chosen)
            choice.emplace_back(cursor_, cells);
        const bool sparse = (packing_ & kActiveMask) != 0 && kind != kAllStored;
        const std::size_t stored = sparse ? on.count() : static_cast<std::size_t>(cells);
        unpack(stored);
        if (stored == static_cast<std::size_t>(cells)) {
            std::ranges::copy(numbers_, out);
            return;
        }
        const float* next = numbers_.data();
        for (int i = 0; i < cells; ++i, out += components_)
            if (on.on(i)) {
                std::copy_n(next, components_, out);
                next += components_;
            } else {
                std::copy_n((chosen && choice.front().on(i) ? second : first).data(), components_,
                            out);
            }
    }

    /// Unpacks `count` values into numbers_.
    void unpack(std::size_t count) {
        numbers_.resize(count * components_);
        if (count == 0 && grid_.half)
            return; // nothing is written then, not even a length
        const std::size_t bytes = numbers_.size() * (grid_.half ? 2 : 4);
        const std::span<const std::byte> raw = raw_bytes(bytes);
        if (!grid_.half) {
            std::ranges::copy(raw, reinterpret_cast<std::byte*>(numbers_.data()));
            return;
        }
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, &raw[2 * i], 2);
            numbers_[i] = glm::unpackHalf1x16(half);
        }
    }

    /// The next `bytes` bytes, unpacked. A length of 0 or below says that so many stand there as
    /// they are.
    std::span<const std::byte> raw_bytes(std::size_t bytes) {
        if ((packing_ & (kBlosc | kZip)) == 0)
            return cursor_.take(bytes);
        const auto length = cursor_.number<std::int64_t>();
        if (length <= 0) {
            if (length != -static_cast<std::int64_t>(bytes))
                refuse("values", fmt::format("a length of {}", length),
                       fmt::format("-{}", bytes).c_str());
            return cursor_.take(bytes);
        }
        const std::span<const std::byte> packed = cursor_.take(static_cast<std::uint64_t>(length));
        scratch_.resize(std::max<std::size_t>(bytes, 1));
        if (!((packing_ & kBlosc) != 0 ? unblosc(packed, bytes) : unzip(packed, bytes)))
            refuse("values", fmt::format("{} bytes that do not unpack", length),
                   fmt::format("{} bytes, packed", bytes).c_str());
        return std::span(scratch_).first(bytes);
    }

    bool unblosc(std::span<const std::byte> packed, std::size_t bytes) {
        std::size_t unpacked =
            0; // blosc trusts the sizes in its header: they are compared with ours first
        return packed.size() >= BLOSC_MIN_HEADER_LENGTH &&
               blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) == 0 &&
               unpacked == bytes &&
               blosc_decompress_ctx(packed.data(), scratch_.data(), bytes, 1) ==
                   static_cast<int>(bytes);
    }
    bool unzip(std::span<const std::byte> packed, std::size_t bytes) {
        uLongf unpacked = static_cast<uLongf>(bytes);
        return ::uncompress(reinterpret_cast<Bytef*>(scratch_.data()), &unpacked,
                            reinterpret_cast<const Bytef*>(packed.data()),
                            static_cast<uLong>(packed.size())) == Z_OK &&
               unpacked == bytes;
    }

    void check_box() const {
        glm::ivec3 low(INT_MAX), high(INT_MIN);
        for (const SparseGrid::Leaf& leaf : grid_.leaves)
            for (int bit = 0; bit < SparseGrid::kLeafVoxels; ++bit)
                if (leaf.is_on(bit)) {
                    const glm::ivec3 at = leaf.origin + glm::ivec3(bit >> 6, bit >> 3 & 7, bit & 7);
                    low = glm::min(low, at);
                    high = glm::max(high, at);
                }
        for (const SparseGrid::Tile& tile : grid_.tiles)
            if (tile.active) {
                low = glm::min(low, tile.origin);
                high = glm::max(high, tile.origin + (tile.side - 1));
            }
        if (active_ == 0)
            return;
        const glm::i64vec3 size = glm::i64vec3(high) - glm::i64vec3(low) + std::int64_t{1};
        if (std::max({size.x, size.y, size.z}) > kMaxVdbSide)
            cursor_.over(name_, fmt::format("a box of {} x {} x {} voxels", size.x, size.y, size.z),
                         fmt::format("at most {} a side", kMaxVdbSide));
    }

    VdbCursor& cursor_;
    std::uint32_t packing_;
    SparseGrid& grid_;
    std::string name_;
    std::size_t components_;
    std::uint64_t active_ = 0;
    std::vector<float> numbers_;
    std::vector<std::byte> scratch_;
};

} // namespace

void read_vdb_tree(VdbCursor& cursor, std::uint64_t block_at, std::uint32_t packing,
                   SparseGrid& grid) {
    if (packing > (kZip | kActiveMask | kBlosc))
        cursor.refuse("grid " + base::printable(grid.name) + ": compression",
                      std::to_string(packing), "0 to 7");
    TreeReading reading(cursor, packing, grid);
    reading.topology();
    cursor.seek(block_at);
    reading.leaf_values();
}

} // namespace sward::texgen
