// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "blades/cull_tests.h"
#include "render/world.h"

namespace sward::render {

/// Which tiers draw. Reference: every blade as geometry out to `reference_distance_m`,
/// supersampled, bare ground beyond.
enum class Tiers { kAll, kBlades, kShells, kReference };
/// How a blade changes tier. kRank ships; the others exist for tests: kOff draws both tiers whole
/// (double), kHard swaps all blades at one distance, kFade dissolves every blade by the same pixel
/// dither.
enum class HandoverMode { kRank, kOff, kHard, kFade };

/// What FieldState::simulate takes: once a frame, whatever is drawn of it.
struct SimulationSettings {
    bool physics = true; ///< blades near the eyes live (J4 to J6); else all are grouped (W3)
    double simulated_radius_m =
        8; ///< around an eye; memory and time of the physics grow with its square
    std::size_t most_simulated_bytes =
        64ull << 20; ///< of their states, 16 a blade: when they are spent the farthest are grouped
    int most_physics_steps =
        0;                   ///< in a frame, 0: any number; steps before the last ones are left out
    int most_wind_steps = 0; ///< of the local window in a frame, 0: any number; it then lags behind
                             ///< the time instead of the frame
    bool wait_in_passes =
        false; ///< each pass's time is its own, in software too; costs the overlap of passes
};

/// One picture, and, where one call simulates and draws, its simulation.
struct FrameSettings : SimulationSettings {
    int width = 1280;
    int height = 720;
    int samples = 4; ///< MSAA; memory and fill cost grow with it. 1, 2 or 4
    Tiers tiers = Tiers::kAll;
    FarScheme far = FarScheme::kMarch; ///< another needs World::far to be it
    HandoverMode handover = HandoverMode::kRank;
    bool terrain = true, blades = true, shells = true, slices = true,
         sky = true;          ///< switches of the panel
    blades::CullTests cull;   ///< how blades that cannot be seen are found
    int force_far_level = -1; ///< >= 0: only this level of the far tier, at every distance (tests)
    double blades_distance_m =
        200; ///< how far --tiers blades draws geometry; cost grows with its square
    double reference_distance_m = 60; ///< likewise for the reference
    int reference_grid = 4;           ///< n x n jittered frames are averaged; cost grows with n^2
    float exposure = 1.0f;
    bool count_steps =
        false; ///< of the march (FrameStats::march_steps); costs two atomic additions a pixel
    bool aov = false;                  ///< also fill the AOV targets; costs about a third more fill
    std::optional<glm::dvec3> lod_eye; ///< where tier selection measures distances from (world
                                       ///< metres); the eye but in tests
};

struct PassTime {
    std::string name;
    double gpu_ms = 0;
    double cpu_ms = 0;
};

struct FrameStats {
    std::vector<PassTime> passes;        ///< in the order of frame.cpp
    std::uint64_t blades_considered = 0; ///< tested by the cull pass
    std::uint64_t blades_drawn = 0;
    std::uint64_t culled_by_frustum = 0, culled_by_orientation = 0, culled_by_distance = 0,
                  culled_by_occlusion = 0, culled_by_samples = 0;
    std::uint64_t blades_simulated = 0; ///< that have a state
    std::uint64_t patches_stepped = 0;  ///< of 128 blades, in all steps since the field began
    std::uint64_t physics_steps = 0;    ///< since time 0
    std::uint64_t physics_bytes = 0;    ///< all buffers of the blades' physics
    std::uint64_t sphere_pairs =
        0; ///< of a patch and a collider that it may meet, in the frame's steps
    std::uint64_t track_pages = 0;        ///< in the tracks' pool
    std::uint64_t track_bytes = 0;        ///< of the pool, on the GPU
    std::uint64_t track_memory_bytes = 0; ///< of pages that are out of it
    std::uint64_t surface_bytes = 0;      ///< of a mesh's blades and of what culls them
    std::uint64_t shell_fragments = 0; ///< of the march: pixels whose ray went through columns; of
                                       ///< the planes: that were written
    std::uint64_t slice_fragments = 0; ///< likewise through slabs; slices
    std::uint64_t march_steps = 0;     ///< of all its rays, where FrameSettings::count_steps asks
    std::uint64_t march_reads = 0;     ///< texels that it fetched, likewise
    std::uint64_t gpu_bytes = 0;       ///< buffers and textures alive
};

} // namespace sward::render
