// SPDX-License-Identifier: Apache-2.0
// G2: making a texture periodic by laying one border over the opposite one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sward::texgen {

struct Volume;

/// Where the border that was cut off (the far one, moved to the near side) and what it lies on
/// meet. Column x of the overlap shows, in row r: the cut-off border where x < over[r], the larger
/// of both where x < under[r], else what was there. Always 1 <= over[r] <= under[r] <= width - 1.
struct Overlap {
    int width = 0;
    std::vector<int> over, under;

    enum class Take { kOver, kLarger, kUnder };
    [[nodiscard]] Take at(int x, int row) const {
        const auto r = static_cast<std::size_t>(row);
        return x < over[r] ? Take::kOver : x < under[r] ? Take::kLarger : Take::kUnder;
    }
};

/// What it costs to change over at a texel of the overlap, row-major, rows of `width`: the
/// difference of both sides where the side that is there anyway loses against the other.
struct OverlapCost {
    int width = 0;
    int rows = 0;
    std::vector<float> over;  ///< difference where the lower one is larger
    std::vector<float> under; ///< difference where the cut-off one is larger
};

/// The two paths of least cost along the overlap (minimum-error boundaries, Efros and Freeman
/// 2001), each moving by at most one column a row. `closed`: the rows are a circle, and the paths
/// close. `width` must be at least 3.
[[nodiscard]] Overlap find_overlap(const OverlapCost& cost, bool closed);

/// How much is cut off each side.
struct SeamCut {
    double share = 0.125; ///< of the side
    int texels = 0;       ///< instead, when above 0

    /// Throws base::Error when what is left is under twice the cut or the cut under 3: kUsage, or
    /// kBadInput naming `what` where the cut is nobody's wish.
    [[nodiscard]] int of(int side, const std::filesystem::path& what) const;
};

/// Joints of a tiling against the interior.
struct JointReport {
    double joint = 0;    ///< mean gradient across the joint, the larger of both axes
    double interior = 0; ///< median over the interior's columns and rows of the same mean gradient;
                         ///< the largest where most have none
    [[nodiscard]] std::string words() const; ///< "1.30 times the interior's"
    [[nodiscard]] double ratio() const {
        return interior > 0 ? joint / interior : joint > 0 ? 1e9 : 0;
    }
};

/// A joint is an edge where the tiling's texture visibly breaks (issue: at most 1.2 of the
/// interior's median).
inline constexpr double kMostJointRatio = 1.2;

/// Gives the cells of a volume their places in a periodic one of side cells - cut on the two level
/// axes.
struct CellMove {
    std::size_t from = 0; ///< index into the cells
    glm::ivec3 to{0};
};
struct CellSeam {
    std::vector<CellMove> moves; ///< cells that are kept
    glm::ivec3 low{0};           ///< corner of the box that `to` counts from
    glm::ivec3 size{0};          ///< of the box after the cut; `up` axis as before
    JointReport before, after;
};
/// `key` decides between two cells; a whole cell wins. `up`: the axis that is not cut (1: y, 2: z).
/// `cut` per axis.
struct CellQuery {
    std::span<const glm::ivec3> at;
    std::span<const float> key;
    int up = 1;
    glm::ivec3 low{0}, size{0}; ///< the box
    glm::ivec3 cut{0};          ///< cells cut off each axis; 0 along `up`
};
[[nodiscard]] CellSeam seam_cells(const CellQuery& query);

/// Joints of a periodic volume: gradients of density summed along `up`.
[[nodiscard]] JointReport measure_cells(const CellQuery& query);

/// Makes a volume periodic and square: cuts `cut` off the shorter side and as much more as it takes
/// off the longer.
[[nodiscard]] Volume seam_volume(const Volume& volume, const SeamCut& cut,
                                 const std::filesystem::path& name);

} // namespace sward::texgen
