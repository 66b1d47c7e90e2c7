// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sward::scene {

/// Something that touches the ground under a path: a wheel, a skid, a mower's deck. Its place is
/// relative to the path's.
struct TrackFoot {
    enum class Kind { kBox, kWheel } kind = Kind::kBox;
    std::string path;       ///< name of a [path.*]
    glm::dvec2 place{0, 0}; ///< x to the right, z behind (m)
    glm::dvec2 size{1, 1};  ///< box: width, depth; wheel: width, radius (m)
    double height_m =
        0;           ///< of the underside over the ground; a path that flies adds its own height
    double load = 1; ///< share of the stems that it breaks, of those that a full load does
};

/// [tracks]: what stays to be seen of what has passed (methods.md C1 to C6). docs/tracks.md has the
/// table.
struct TrackSpec {
    double cell_m = 0.25;
    int pages = 225;            ///< of 128 x 128 cells, at most
    double wave_mps = 2;        ///< c0
    double rate_wave_mps = 1;   ///< c_omega
    double wave_gain_m = 0.2;   ///< mu
    double damping = 0.15;      ///< l
    double recovery_per_s2 = 8; ///< k; 0: the paper's, in which a bend spreads and never rises
    double broken = 0.9;        ///< share of stems that a full load breaks
    double lasting_s = 21600;   ///< until 1/e of those is left
    double memory_mb = 64;      ///< of pages that are out of the pool
    std::vector<TrackFoot> feet;
    std::filesystem::path mask;     ///< what lies at time 0: share of stems, 0..1; empty: nothing
    std::filesystem::path mask_way; ///< the way that they lie, 0..1 for 0 to 360 degrees; empty:
                                    ///< mask_way_deg everywhere
    double mask_way_deg = 0;        ///< as yaw: 0 north, positive to the east
    glm::dvec2 mask_place{0, 0};    ///< its middle, world x, z
    glm::dvec2 mask_size_m{0, 0}; ///< zero: where it says that it lies, else over the whole terrain
};

} // namespace sward::scene
