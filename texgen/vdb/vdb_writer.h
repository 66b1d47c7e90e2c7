// SPDX-License-Identifier: Apache-2.0
// What OpenVDB itself does for us: it writes. Slow to compile, it is included by vdb_archive.cpp
// alone.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "texgen/vdb/volume.h"

namespace sward::texgen {

class SparseGrid;
struct VdbMove;

/// A volume as the bytes of an OpenVDB file: `density` first, half floats, y up, a voxel's value at
/// its middle.
[[nodiscard]] std::vector<std::byte> encode_vdb(const Volume& volume);

/// A file of grids as they were read, but for their voxels' places.
class VdbBuilder {
public:
    VdbBuilder();
    ~VdbBuilder();
    VdbBuilder(const VdbBuilder&) = delete;
    VdbBuilder& operator=(const VdbBuilder&) = delete;

    /// A grid of `grid`'s kind, transform and metadata with the active voxels among `moves`; gets
    /// `period_m`.
    void add_moved(const SparseGrid& grid, std::span<const VdbMove> moves, double period);
    /// Equal grids give equal bytes.
    [[nodiscard]] std::vector<std::byte> bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace sward::texgen
