// SPDX-License-Identifier: Apache-2.0
// G2 on a sparse volume: only active cells are touched.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "texgen/seam/seam.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {
namespace {

/// A cell on its way: its index in the query and where it stands now.
struct Cell {
    std::size_t from = 0;
    glm::ivec3 at{0};
    float key = 0;
};

/// Sums along `up`, rows of the box's second level axis.
std::vector<float> plan_of(std::span<const Cell> cells, const glm::ivec3& size, int u, int v) {
    std::vector<float> plan(static_cast<std::size_t>(size[u]) * static_cast<std::size_t>(size[v]));
    for (const Cell& c : cells)
        plan[static_cast<std::size_t>(c.at[v]) * static_cast<std::size_t>(size[u]) +
             static_cast<std::size_t>(c.at[u])] += c.key;
    return plan;
}

/// Steps from column x to the next, round the joint, for every x.
ColumnSteps steps_of(const std::vector<float>& plan, int width, int rows, bool across) {
    const int count = across ? rows : width, along = across ? width : rows;
    ColumnSteps out;
    for (int i = 0; i < count; ++i) {
        const int next = (i + 1) % count;
        double step = 0, content = 0;
        for (int j = 0; j < along; ++j) {
            const auto value = [&](int k) {
                return plan[static_cast<std::size_t>(across ? k : j) *
                                static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(across ? j : k)];
            };
            step += std::abs(value(next) - value(i));
            content += std::abs(value(next)) + std::abs(value(i));
        }
        out.step.push_back(step / along);
        out.content.push_back(content / along);
    }
    return out;
}

JointReport joints(std::span<const Cell> cells, const glm::ivec3& size, int u, int v) {
    const std::vector<float> plan = plan_of(cells, size, u, v);
    const JointReport x = joint_of(steps_of(plan, size[u], size[v], false)),
                      y = joint_of(steps_of(plan, size[u], size[v], true));
    return x.ratio() >= y.ratio() ? x : y;
}

/// Lays the last `cut` columns of `axis` over the first ones.
class AxisSeam {
public:
    AxisSeam(std::vector<Cell>& cells, glm::ivec3& size, int axis, int other)
        : cells_(cells), size_(size), axis_(axis), other_(other) {}

    void run(int cut, bool closed) {
        const int kept = size_[axis_] - cut;
        std::vector<Cell> over, under, rest;
        for (Cell cell : cells_) {
            if (cell.at[axis_] >= kept) {
                cell.at[axis_] -= kept;
                over.push_back(cell);
            } else {
                (cell.at[axis_] < cut ? under : rest).push_back(cell);
            }
        }
        std::ranges::sort(over, before);
        std::ranges::sort(under, before);
        OverlapCost cost{cut, size_[other_], {}, {}};
        cost.over.resize(static_cast<std::size_t>(cut) * static_cast<std::size_t>(cost.rows));
        cost.under = cost.over;
        const auto place = [&](const Cell& c) {
            return static_cast<std::size_t>(c.at[other_]) * static_cast<std::size_t>(cut) +
                   static_cast<std::size_t>(c.at[axis_]);
        };
        pairs(over, under, [&](const Cell* o, const Cell* u) {
            const float a = o ? o->key : 0, b = u ? u->key : 0;
            const std::size_t i = place(o ? *o : *u);
            (b > a ? cost.over : cost.under)[i] += std::abs(a - b);
        });
        const Overlap overlap = find_overlap(cost, closed);
        pairs(over, under, [&](const Cell* o, const Cell* u) {
            const Cell& any = o ? *o : *u;
            const Overlap::Take take = overlap.at(any.at[axis_], any.at[other_]);
            const bool larger = o && (!u || o->key >= u->key);
            const Cell* winner = take == Overlap::Take::kOver    ? o
                                 : take == Overlap::Take::kUnder ? u
                                 : larger                        ? o
                                                                 : u;
            if (winner)
                rest.push_back(*winner);
        });
        cells_ = std::move(rest);
        size_[axis_] = kept;
    }

private:
    static bool before(const Cell& a, const Cell& b) {
        return std::tie(a.at.x, a.at.y, a.at.z) < std::tie(b.at.x, b.at.y, b.at.z);
    }
    /// visit(over, under) for every place where either stands.
    template<typename Visit>
    static void pairs(const std::vector<Cell>& over, const std::vector<Cell>& under,
                      const Visit& visit) {
        auto o = over.begin();
        auto u = under.begin();
        while (o != over.end() || u != under.end()) {
            if (u == under.end() || (o != over.end() && before(*o, *u)))
                visit(&*o++, nullptr);
            else if (o == over.end() || before(*u, *o))
                visit(nullptr, &*u++);
            else
                visit(&*o++, &*u++);
        }
    }

    std::vector<Cell>& cells_;
    glm::ivec3& size_;
    int axis_, other_;
};

std::vector<Cell> cells_of(const CellQuery& query) {
    std::vector<Cell> cells(query.at.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = {i, query.at[i] - query.low, query.key[i]};
    return cells;
}

int second_axis(int up) {
    return up == 1 ? 2 : 1;
}

} // namespace

JointReport measure_cells(const CellQuery& query) {
    return joints(cells_of(query), query.size, 0, second_axis(query.up));
}

CellSeam seam_cells(const CellQuery& query) {
    CellSeam out;
    const int u = 0, v = second_axis(query.up);
    std::vector<Cell> cells = cells_of(query);
    out.size = query.size;
    out.low = query.low;
    out.before = joints(cells, out.size, u, v);
    AxisSeam(cells, out.size, u, v).run(query.cut[u], false);
    AxisSeam(cells, out.size, v, u).run(query.cut[v], true); // u is a circle by now
    out.after = joints(cells, out.size, u, v);
    out.moves.reserve(cells.size());
    for (const Cell& c : cells)
        out.moves.push_back({c.from, c.at});
    return out;
}

Volume seam_volume(const Volume& volume, const SeamCut& cut, const std::filesystem::path& name) {
    std::vector<glm::ivec3> at(volume.at.size());
    for (std::size_t i = 0; i < at.size(); ++i)
        at[i] = {volume.at[i].x, volume.at[i].y, volume.at[i].z};
    const int shorter = std::min(volume.cells.x, volume.cells.z);
    const int kept = shorter - cut.of(shorter, name);
    CellQuery query{at, volume.density, 1, {0, 0, 0}, volume.cells, {}};
    query.cut = {volume.cells.x - kept, 0, volume.cells.z - kept};
    for (const int axis : {0, 2}) // the longer side's larger cut is held to the same bounds
        (void)SeamCut{.texels = query.cut[axis]}.of(volume.cells[axis], name);
    CellSeam seam = seam_cells(query);
    std::ranges::sort(seam.moves, [](const CellMove& a, const CellMove& b) {
        return std::tie(a.to.y, a.to.z, a.to.x) < std::tie(b.to.y, b.to.z, b.to.x);
    });
    Volume out;
    out.voxel_m = volume.voxel_m;
    out.cells = seam.size;
    out.period_m = kept * volume.voxel_m;
    out.canopy_m = volume.canopy_m;
    out.preset = volume.preset;
    out.set_seed = volume.set_seed;
    out.format_version = volume.format_version;
    out.light = volume.light;
    const auto pick = [&](const auto& from, auto& to) {
        if (from.empty())
            return;
        to.reserve(seam.moves.size());
        for (const CellMove& move : seam.moves)
            to.push_back(from[move.from]);
    };
    for (const CellMove& move : seam.moves)
        out.at.push_back({static_cast<std::uint16_t>(move.to.x),
                          static_cast<std::uint16_t>(move.to.y),
                          static_cast<std::uint16_t>(move.to.z)});
    pick(volume.density, out.density);
    pick(volume.tangent, out.tangent);
    pick(volume.colour, out.colour);
    pick(volume.rank, out.rank);
    pick(volume.seed, out.seed);
    pick(volume.others, out.others);
    return out;
}

} // namespace sward::texgen
