// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blades/cull_pass.h"
#include "blades/depth_pyramid.h"
#include "blades/draw_pass.h"
#include "blades/simulation.h"
#include "gl/pass.h"
#include "lod/lod.h"
#include "render/mesh_ground.h"
#include "render/mesh_pass.h"
#include "render/renderer.h"
#include "render/screen_passes.h"
#include "render/targets.h"
#include "shells/far_appearance.h"
#include "shells/far_pass.h"
#include "shells/march_light.h"
#include "shells/march_pass.h"
#include "terrain/terrain_pass.h"
#include "wind/sources.h"
#include "wind/wind.h"

namespace sward::render {

/// Draw passes of one variant: with or without AOV outputs.
struct DrawPasses {
    DrawPasses(bool aov, bool block_shapes, bool surface)
        : terrain(aov), blades(aov), shells(shells::FarPass::Family::kShells, aov, block_shapes),
          slices(shells::FarPass::Family::kSlices, aov, block_shapes), march(aov, surface), screen(aov), meshes(aov) {}
    terrain::TerrainPass terrain;
    blades::DrawPass blades;
    shells::FarPass shells, slices;
    shells::MarchPass march;
    ScreenPasses screen;
    MeshPass meshes;
    /// The blades of a mesh; made when a scene has one.
    [[nodiscard]] blades::DrawPass& surface(bool aov);
    void reload(std::vector<std::string>& failures);

private:
    std::unique_ptr<blades::DrawPass> surface_;
};

/// Blocks of ground in view, and the shells and slices over them.
struct FieldView {
    std::vector<terrain::VisibleBlock> blocks;
    bool fine = false; ///< finer than the clipmap
    shells::FarList far;
    shared::FarShares shares{}; ///< of the raster schemes
};

/// What one picture of a frame is drawn with: a still has one, the reference one per jitter.
struct Shot {
    glm::dvec3 anchor{0};
    lod::Bands bands;
    shared::FrameConstants constants{};
    terrain::Detail detail;
};

struct Renderer::Impl {
    explicit Impl(World inputs);

    /// The frame (design: a frame, top to bottom). `jitter` in pixels; `picture` counts the jittered pictures of one frame.
    void draw_frame(const View& view, const FrameSettings& settings);
    void draw_picture(const View& view, const FrameSettings& settings, int picture, int pictures);
    /// A field on elevation: what has to be ready before its passes; its passes.
    [[nodiscard]] FieldView prepare_field(const FrameSettings& settings, const Shot& shot);
    void draw_field(const FrameSettings& settings, const Shot& shot, const FieldView& field);
    /// The far field over what is drawn, resolved.
    void draw_far(const FrameSettings& settings, const Shot& shot, const FieldView& field);
    void build_pyramid(const FrameSettings& settings);
    void draw_mesh_ground(const FrameSettings& settings, const Shot& shot);
    /// The far field of a mesh's set, likewise.
    void draw_mesh_far(const FrameSettings& settings, const Shot& shot);
    void draw_objects(const FrameSettings& settings, const Shot& shot, double time_s);
    void make_object_meshes();
    /// Pages of living blades in and out, and whole steps of the wind and the blades up to the view's time.
    void simulate(const View& view, const FrameSettings& settings);
    void draw_blades(const FrameSettings& settings, const Shot& shot);
    /// The blades that live, made anew for other bounds; null where none does.
    [[nodiscard]] blades::LivingBlades* wake(const FrameSettings& settings);
    [[nodiscard]] const blades::LivingBlades* living(const FrameSettings& settings) const;
    [[nodiscard]] Shot make_shot(const View& view, const FrameSettings& settings, glm::dvec2 jitter) const;
    [[nodiscard]] DrawPasses& passes(bool aov);

    /// The wind's inputs, which Impl made.
    [[nodiscard]] wind::Sources& sources() const { return static_cast<wind::Sources&>(*wind.inputs()); }

    World world;
    double response; ///< bend per m/s of the set's mean blade
    terrain::Surface surface;
    terrain::Clipmap clipmap;
    wind::Wind wind;
    shells::MarchTextures march_textures;
    shells::CanopyTargets canopy;
    shells::SurfaceTargets surface_canopy; ///< of a mesh
    shells::FarTextures far_textures; ///< of the raster schemes, where the world wants them
    shells::FarAppearance far_appearance;
    shells::MarchLight march_light;
    terrain::BlockMesh block_mesh;
    terrain::BlockSamples block_samples;
    gl::Buffer blade_records, frame_buffer;
    blades::CullPass cull;
    blades::DepthPyramid depth_pyramid;
    blades::Colliders colliders;
    std::unique_ptr<blades::Simulation> simulation; ///< of the set's blades; made for the first frame that wants it
    std::unique_ptr<DrawPasses> plain_passes, aov_passes;
    std::unique_ptr<MeshGround> mesh_ground; ///< a scene on a mesh: no field on elevation
    std::unique_ptr<blades::SurfaceSimulation> surface_simulation; ///< of a mesh's; goes before its ground
    std::map<std::filesystem::path, MeshBuffer> object_meshes; ///< under the scene's names; "": the ball
    Targets targets;
    gl::PassTimers timers;
    double mean_blade_width_m = 0;
    FrameSettings last_settings;
    FrameStats counts; // of the frame being drawn; times are read later
};

} // namespace sward::render
