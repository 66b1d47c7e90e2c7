// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "blades/colliders.h"
#include "blades/cull_tests.h"
#include "grass/grass_set.h"
#include "scene/heightfield.h"
#include "scene/image.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace sward::render {

/// Which tiers draw. Reference: every blade as geometry out to `reference_distance_m`, supersampled, bare ground beyond.
enum class Tiers { kAll, kBlades, kShells, kReference };
/// How a blade changes tier. kRank ships; the others exist for tests: kOff draws both tiers whole (double), kHard swaps all
/// blades at one distance, kFade dissolves every blade by the same pixel dither.
enum class HandoverMode { kRank, kOff, kHard, kFade };

/// How the far field is drawn: the march; for comparison shells and slices one by one, in the shares that cover as blades do, or as published.
enum class FarScheme { kMarch, kPlanes, kPublished };

struct FrameSettings {
    int width = 1280;
    int height = 720;
    int samples = 4;            ///< MSAA; memory and fill cost grow with it. 1, 2 or 4
    Tiers tiers = Tiers::kAll;
    FarScheme far = FarScheme::kMarch; ///< another needs World::far to be it
    HandoverMode handover = HandoverMode::kRank;
    bool terrain = true, blades = true, shells = true, slices = true, sky = true; ///< switches of the panel
    blades::CullTests cull;     ///< how blades that cannot be seen are found
    int force_far_level = -1;   ///< >= 0: only this level of the far tier, at every distance (tests)
    double blades_distance_m = 200;    ///< how far --tiers blades draws geometry; cost grows with its square
    double reference_distance_m = 60;  ///< likewise for the reference
    int reference_grid = 4;     ///< n x n jittered frames are averaged; cost grows with n^2
    float exposure = 1.0f;
    bool physics = true;        ///< blades near the eye live (J4 to J6); else all are grouped (W3)
    double simulated_radius_m = 8; ///< around the eye; memory and time of the physics grow with its square
    std::size_t most_simulated_bytes = 64ull << 20; ///< of their states, 16 a blade: when they are spent the farthest are grouped
    int most_physics_steps = 0; ///< in a frame, 0: any number; steps before the last ones are left out
    int most_wind_steps = 0;    ///< of the local window in a frame, 0: any number; it then lags behind the time instead of the frame
    bool wait_in_passes = false; ///< each pass's time is its own, in software too; costs the overlap of passes
    bool count_steps = false;    ///< of the march (FrameStats::march_steps); costs two atomic additions a pixel
    bool aov = false;           ///< also fill the AOV targets; costs about a third more fill
};

/// One view of one frame. Poses are above the datum here (Renderer::above_datum resolves agl).
struct View {
    scene::Pose pose;
    scene::Pose lod_pose;  ///< where tier selection measures distances from; equal to pose but in tests
    double time_s = 0;
    std::uint32_t frame_index = 0; ///< nothing drawn depends on it yet: there is no noise in time
};

struct PassTime {
    std::string name;
    double gpu_ms = 0;
    double cpu_ms = 0;
};

struct FrameStats {
    std::vector<PassTime> passes;  ///< in the order of frame.cpp
    std::uint64_t blades_considered = 0; ///< tested by the cull pass
    std::uint64_t blades_drawn = 0;
    std::uint64_t culled_by_frustum = 0, culled_by_orientation = 0, culled_by_distance = 0, culled_by_occlusion = 0;
    std::uint64_t blades_simulated = 0;  ///< that have a state
    std::uint64_t patches_stepped = 0;   ///< of 128 blades, in all steps since the renderer began
    std::uint64_t physics_steps = 0;     ///< since time 0
    std::uint64_t physics_bytes = 0;     ///< all buffers of the blades' physics
    std::uint64_t sphere_pairs = 0;      ///< of a patch and a collider that it may meet, in the frame's steps
    std::uint64_t surface_bytes = 0;     ///< of a mesh's blades and of what culls them
    std::uint64_t shell_fragments = 0;   ///< of the march: pixels whose ray went through columns; of the planes: that were written
    std::uint64_t slice_fragments = 0;   ///< likewise through slabs; slices
    std::uint64_t march_steps = 0;       ///< of all its rays, where FrameSettings::count_steps asks
    std::uint64_t march_reads = 0;       ///< texels that it fetched, likewise
    std::uint64_t gpu_bytes = 0;         ///< buffers and textures alive
};

/// Inputs of a renderer, loaded by the host (the core reads no heavy formats).
struct World {
    scene::Scene scene;
    scene::Heightfield elevation;
    scene::DensityMask mask; ///< width 0: the slope rule
    grass::GrassSet grass;   ///< empty where the scene stands on a mesh
    FarScheme far = FarScheme::kMarch; ///< whose textures are kept on the GPU, beside the march's
    scene::Mesh surface;     ///< terrain.surface; no triangles: a scene on elevation
    std::map<std::filesystem::path, scene::Mesh> meshes; ///< those that the scene's obstacles and objects name, under its names
    std::map<std::filesystem::path, scene::SphereSet> spheres; ///< the meshes of objects that grass feels, packed; under the same names
};

/// The library's face. Needs a current GL 4.5 core context at construction, in every call and at destruction; owns no
/// window and no thread. Throws base::Error (kNoGpu for shader and context trouble).
class Renderer {
public:
    explicit Renderer(World world);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws a frame into Renderer's own targets.
    void draw(const View& view, const FrameSettings& settings);
    /// Copies the tone-mapped frame into the framebuffer `fbo` (0: the window's), bottom-left at `x`, `y`.
    void present(std::uint32_t fbo, int x, int y);

    /// The frame just drawn, tone-mapped, 8-bit sRGB. Waits for the GPU.
    [[nodiscard]] scene::Picture read_picture();
    /// The frame just drawn as linear floats. `names` out of color, depth, tier, coverage, tangent, normal, rank; needs
    /// settings.aov for all but color and depth. Channel names: docs/commands.md.
    [[nodiscard]] scene::Image read_aovs(const std::vector<std::string>& names);
    /// Counts and times of the frame just drawn. Waits for the GPU.
    [[nodiscard]] FrameStats stats();

    /// Height of the ground surface that is drawn, metres above the datum, at local x, z (clamped to the terrain). 0 in a scene on a
    /// mesh, which may have any number of surfaces there.
    [[nodiscard]] double ground_height(double x, double z) const;
    /// The pose with its height above the datum (agl resolved).
    [[nodiscard]] scene::Pose above_datum(const scene::Pose& pose) const;
    /// Wind (m/s, east and south) at a point and time: the answer that every shader gets, as far as it has come back from the
    /// GPU: a frame or two late. Never waits.
    [[nodiscard]] glm::dvec2 wind_at(double x, double z, double time_s) const;
    /// Waits until wind_at() knows the frame just drawn.
    void wait_for_wind();

    /// Puts these arrows in the place of the scene's, from the next step of the wind on: for an editor. Every parent is
    /// among them, and chains end.
    void set_wind_arrows(std::vector<scene::WindArrow> arrows);

    /// Spheres that the host drives (world metres, y above the datum) and that push blades, as at `time_s`, the time of the next frame;
    /// those of the same number in the call before came from there. Throws base::Error(kBadInput) for a radius not above 0.
    void set_colliders(std::vector<blades::HostSphere> spheres, double time_s);

    /// Recompiles programs whose source changed; returns messages of those that failed (the old program stays).
    [[nodiscard]] std::vector<std::string> reload_shaders();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace sward::render
