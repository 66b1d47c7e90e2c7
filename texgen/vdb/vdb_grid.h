// SPDX-License-Identifier: Apache-2.0
// A grid of an OpenVDB file as plain arrays: what our own reader makes, so that the library, which
// takes files on trust, reads none.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sward::texgen {

/// A value of a grid's or file's metadata as it stands in the file.
struct VdbMeta {
    std::string name, type; ///< "period_m", "float"
    std::vector<std::byte> value;
};

/// Index to world of an affine map: world = (i, j, k, 1) * m, row by row.
struct VdbTransform {
    std::array<double, 16> m{};
    [[nodiscard]] double at(int row, int column) const {
        return m[static_cast<std::size_t>(4 * row + column)];
    }
    /// Length of a voxel's edge along axis `i` of the index space.
    [[nodiscard]] double voxel(int i) const {
        return std::sqrt(at(i, 0) * at(i, 0) + at(i, 1) * at(i, 1) + at(i, 2) * at(i, 2));
    }
    [[nodiscard]] double determinant() const;
    /// The same within rounding.
    [[nodiscard]] bool near(const VdbTransform& other) const;
};

/// A grid of floats (1 component) or of vectors (3).
class SparseGrid {
public:
    static constexpr int kLeafSide = 8, kLeafVoxels = 512;
    struct Leaf {
        glm::ivec3 origin{0};              ///< a multiple of 8
        std::array<std::uint64_t, 8> on{}; ///< active voxels; bit (x * 8 + y) * 8 + z
        [[nodiscard]] bool is_on(int bit) const {
            return on[static_cast<std::size_t>(bit) / 64] >> (bit % 64) & 1;
        }
    };
    /// A cube of one value.
    struct Tile {
        glm::ivec3 origin{0};
        int side = 0; ///< 8, 128 or 4096
        bool active = false;
        std::array<float, 3> value{};
    };

    std::string name; ///< without the mark that tells grids of one name apart
    int components = 1;
    bool half = false; ///< stored as half floats
    std::vector<VdbMeta> meta;
    VdbTransform transform;
    std::array<float, 3> background{};
    std::vector<Leaf> leaves;
    std::vector<float> values; ///< of every leaf, kLeafVoxels * components
    std::vector<Tile> tiles;   ///< active, or of another value than the background

    /// Sorts leaves' and tiles' places for at(). False where two stand in one place.
    [[nodiscard]] bool index();

    /// The value at a voxel, and whether it is active. `hint`: any number, better the one that the
    /// call before left.
    struct Value {
        const float* at = nullptr;
        bool active = false;
    };
    [[nodiscard]] Value at(const glm::ivec3& voxel, std::size_t& hint) const;

    [[nodiscard]] const VdbMeta* find_meta(const char* key, const char* type) const;
    /// A number of the metadata; false where there is none of that name and type.
    template<typename T>
    [[nodiscard]] bool read_meta(const char* key, const char* type, T& out) const;
    [[nodiscard]] std::string text_meta(const char* key) const;
    [[nodiscard]] bool is_level_set() const { return text_meta("class") == "level set"; }

    /// visit(voxel, value) for every active voxel, those of active tiles too.
    template<typename Visit> void for_active(const Visit& visit) const {
        for (std::size_t i = 0; i < leaves.size(); ++i)
            for (std::size_t word = 0; word < 8; ++word)
                for (std::uint64_t bits = leaves[i].on[word]; bits != 0; bits &= bits - 1) {
                    const int bit = static_cast<int>(word) * 64 + std::countr_zero(bits);
                    visit(leaves[i].origin + glm::ivec3(bit >> 6, bit >> 3 & 7, bit & 7),
                          value_of(i, bit));
                }
        for (const Tile& tile : tiles)
            for (int x = 0; tile.active && x < tile.side; ++x)
                for (int y = 0; y < tile.side; ++y)
                    for (int z = 0; z < tile.side; ++z)
                        visit(tile.origin + glm::ivec3(x, y, z), tile.value.data());
    }

private:
    [[nodiscard]] const float* value_of(std::size_t leaf, int bit) const {
        return &values[(leaf * kLeafVoxels + static_cast<std::size_t>(bit)) *
                       static_cast<std::size_t>(components)];
    }
    std::vector<std::uint32_t> leaf_order_, tile_order_; ///< by place
};

template<typename T> bool SparseGrid::read_meta(const char* key, const char* type, T& out) const {
    const VdbMeta* m = find_meta(key, type);
    if (!m || m->value.size() != sizeof out)
        return false;
    std::copy(m->value.begin(), m->value.end(), reinterpret_cast<std::byte*>(&out));
    return true;
}

} // namespace sward::texgen
