// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/vdb_grid.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace sward::texgen {
namespace {

auto key(const glm::ivec3& v) {
    return std::tuple(v.x, v.y, v.z);
}

/// Indices of `items` by their origins; false where two are alike.
template<typename Item, typename Key>
bool sort_places(const std::vector<Item>& items, const Key& key_of,
                 std::vector<std::uint32_t>& order) {
    order.resize(items.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return key_of(items[i]); });
    return std::ranges::adjacent_find(
               order, {}, [&](std::uint32_t i) { return key_of(items[i]); }) == order.end();
}

glm::ivec3 floor_to(const glm::ivec3& v, int side) {
    return v & glm::ivec3(~(side - 1));
}

} // namespace

double VdbTransform::determinant() const {
    return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
           at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
           at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
}

bool VdbTransform::near(const VdbTransform& other) const {
    const double edge = std::max({voxel(0), voxel(1), voxel(2)});
    for (std::size_t i = 0; i < m.size(); ++i)
        if (!(std::abs(m[i] - other.m[i]) <= 1e-7 * std::max(edge, std::abs(m[i]))))
            return false;
    return true;
}

bool SparseGrid::index() {
    const bool apart = sort_places(
        leaves, [](const Leaf& l) { return key(l.origin); }, leaf_order_);
    return sort_places(
               tiles,
               [](const Tile& t) { return std::tuple_cat(std::tuple(t.side), key(t.origin)); },
               tile_order_) &&
           apart;
}

SparseGrid::Value SparseGrid::at(const glm::ivec3& voxel, std::size_t& hint) const {
    const glm::ivec3 origin = floor_to(voxel, kLeafSide), own = voxel - origin;
    const int bit = (own.x * kLeafSide + own.y) * kLeafSide + own.z;
    if (hint < leaves.size() && leaves[hint].origin == origin)
        return {value_of(hint, bit), leaves[hint].is_on(bit)};
    const auto found = std::ranges::lower_bound(
        leaf_order_, key(origin), {}, [&](std::uint32_t i) { return key(leaves[i].origin); });
    if (found != leaf_order_.end() && leaves[*found].origin == origin) {
        hint = *found;
        return {value_of(hint, bit), leaves[hint].is_on(bit)};
    }
    for (const int side : {8, 128, 4096}) {
        const auto wanted = std::tuple_cat(std::tuple(side), key(floor_to(voxel, side)));
        const auto of = [&](std::uint32_t i) {
            return std::tuple_cat(std::tuple(tiles[i].side), key(tiles[i].origin));
        };
        const auto tile = std::ranges::lower_bound(tile_order_, wanted, {}, of);
        if (tile != tile_order_.end() && of(*tile) == wanted)
            return {tiles[*tile].value.data(), tiles[*tile].active};
    }
    return {background.data(), false};
}

const VdbMeta* SparseGrid::find_meta(const char* wanted, const char* type) const {
    const auto found = std::ranges::find_if(
        meta, [&](const VdbMeta& m) { return m.name == wanted && m.type == type; });
    return found == meta.end() ? nullptr : &*found;
}

std::string SparseGrid::text_meta(const char* wanted) const {
    const VdbMeta* m = find_meta(wanted, "string");
    return m ? std::string(reinterpret_cast<const char*>(m->value.data()), m->value.size())
             : std::string();
}

} // namespace sward::texgen
