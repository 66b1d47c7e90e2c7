// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <numeric>

#include <epoxy/gl.h>

#include "base/error.h"
#include "blades/blade_twin.h"
#include "gl/context.h"
#include "gl/memory.h"
#include "render/impl.h"

namespace sward::render {

namespace {

double mean_width(const grass::GrassSet& set) {
    if (set.levels.empty()) { // a scene on a mesh, which says so itself
        return 0;
    }
    if (set.blades.empty()) { // a texel is as wide as a blade
        return set.side_m / static_cast<double>(set.levels.front().layers.width);
    }
    double sum = 0;
    for (const shared::BladeRecord& blade : set.blades) {
        sum += 2.0 * blade.v1.w;
    }
    return sum / static_cast<double>(std::max<std::size_t>(set.blades.size(), 1));
}

/// A scene on a mesh has level ground at its datum, which is not drawn.
World with_ground(World world) {
    if (!world.surface.triangles.empty()) {
        world.elevation = {2, 2, {1000, 1000}, {0, 0, 0, 0}, {}};
        world.mask = {};
        world.scene.terrain.detail_m = 0;
    }
    return world;
}

} // namespace

Renderer::Impl::Impl(World inputs)
    : world(with_ground(std::move(inputs))), response(world.grass.levels.empty() ? 0 : blades::fit_response(world.grass)), surface(world.elevation, world.scene.terrain.detail_m), clipmap(surface, world.mask),
      wind(world.scene.wind, response,
           std::make_unique<wind::Sources>(world.scene, world.meshes, [this](double x, double z) { return surface.height(x, z); })), march_textures(world.grass.march),
      far_textures(world.far == FarScheme::kMarch ? grass::GrassSet{} : world.grass), far_appearance(world.grass), march_light(world.grass, !world.surface.triangles.empty()),
      blade_records(gl::Buffer::of(std::span<const shared::BladeRecord>(world.grass.blades))), frame_buffer(sizeof(shared::FrameConstants)),
      colliders(world.scene, world.spheres, [this](double x, double z) { return surface.height(x, z); }), mean_blade_width_m(mean_width(world.grass)) {
    if (!world.surface.triangles.empty()) {
        mesh_ground = std::make_unique<MeshGround>(world.surface, world.scene, world.grass.levels.empty() ? nullptr : &world.grass);
        mean_blade_width_m = mesh_ground->has_set() ? mean_blade_width_m : mesh_ground->mean_blade_width_m();
        world.surface = {};
    }
    make_object_meshes();
    // The GPU holds the images now; tens of megabytes are freed here.
    world.grass.march.columns = {};
    world.grass.march.slabs = {};
    for (grass::FarLevel& level : world.grass.levels) {
        level.layers.mips.clear();
        level.layers.mips.shrink_to_fit();
        level.slices.mips.clear();
        level.slices.mips.shrink_to_fit();
        level.layers_shape = level.slices_shape = {};
    }
}

DrawPasses& Renderer::Impl::passes(bool aov) {
    auto& slot = aov ? aov_passes : plain_passes;
    if (!slot) {
        slot = std::make_unique<DrawPasses>(aov, far_textures.block_shapes(), mesh_ground != nullptr);
    }
    return *slot;
}

void DrawPasses::reload(std::vector<std::string>& failures) {
    const auto attempt = [&](auto& pass) {
        try {
            pass.reload();
        } catch (const base::Error& error) {
            failures.emplace_back(error.what());
        }
    };
    attempt(terrain);
    attempt(blades);
    attempt(shells);
    attempt(slices);
    attempt(march);
    attempt(screen);
    attempt(meshes);
    if (surface_) {
        attempt(*surface_);
    }
}

blades::DrawPass& DrawPasses::surface(bool aov) {
    if (!surface_) {
        surface_ = std::make_unique<blades::DrawPass>(aov, true);
    }
    return *surface_;
}

Renderer::Renderer(World world) {
    gl::require_gl45();
    impl_ = std::make_unique<Impl>(std::move(world));
}
Renderer::~Renderer() = default;

void Renderer::draw(const View& view, const FrameSettings& settings) {
    FrameSettings own = settings;
    if (!impl_->mesh_ground && impl_->world.grass.blades.empty() && own.tiers == Tiers::kAll) {
        own.tiers = Tiers::kShells; // a far-only set: the far tier from the eye's feet on
    }
    impl_->draw_frame(view, own);
}

void Renderer::present(std::uint32_t fbo, int x, int y) {
    const Targets& targets = impl_->targets;
    glBlitNamedFramebuffer(targets.display().id(), fbo, 0, 0, targets.width(), targets.height(), x, y, x + targets.width(),
                           y + targets.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

FrameStats Renderer::stats() {
    FrameStats stats = impl_->counts;
    for (const auto& row : impl_->timers.rows()) {
        stats.passes.push_back({row.name, row.gpu_ms, row.cpu_ms});
    }
    const FrameSettings& settings = impl_->last_settings;
    if ((!impl_->mesh_ground || impl_->mesh_ground->has_set()) && (settings.tiers == Tiers::kAll || settings.tiers == Tiers::kShells)) {
        const auto samples = static_cast<std::uint64_t>(impl_->targets.samples());
        DrawPasses& passes = impl_->passes(settings.aov);
        if (settings.far != FarScheme::kMarch && !impl_->mesh_ground) {
            stats.shell_fragments = settings.shells ? passes.shells.samples_passed() / samples : 0;
            stats.slice_fragments = settings.slices ? passes.slices.samples_passed() / samples : 0;
        } else if (settings.far == FarScheme::kMarch && settings.shells && !impl_->march_textures.empty()) {
            stats.shell_fragments = passes.march.pixels().y;
            stats.slice_fragments = passes.march.pixels().x;
            if (settings.count_steps) {
                stats.march_steps = passes.march.work().x;
                stats.march_reads = passes.march.work().y;
            }
        }
    }
    if (stats.blades_considered > 0) {
        const auto counts = (impl_->mesh_ground ? impl_->mesh_ground->grass().cull() : impl_->cull).counts();
        stats.blades_drawn = counts[CULL_KEPT];
        stats.culled_by_frustum = counts[CULL_FRUSTUM];
        stats.culled_by_orientation = counts[CULL_ORIENTATION];
        stats.culled_by_distance = counts[CULL_DISTANCE];
        stats.culled_by_occlusion = counts[CULL_OCCLUSION];
    }
    if (const blades::LivingBlades* living = impl_->living(settings)) {
        stats.blades_simulated = living->blades();
        stats.patches_stepped = living->pass().stepped_patches();
        stats.physics_steps = static_cast<std::uint64_t>(living->steps());
        stats.physics_bytes = impl_->mesh_ground ? impl_->surface_simulation->bytes() : living->pass().bytes();
        stats.sphere_pairs = living->sphere_pairs();
    }
    if (impl_->mesh_ground) {
        stats.surface_bytes = impl_->mesh_ground->grass().bytes();
    }
    stats.gpu_bytes = gl::gpu_bytes();
    return stats;
}

double Renderer::ground_height(double x, double z) const { return impl_->surface.height(x, z); }

scene::Pose Renderer::above_datum(const scene::Pose& pose) const {
    scene::Pose out = pose;
    if (pose.agl) {
        out.position.y += ground_height(pose.position.x, pose.position.z);
        out.agl = false;
    }
    return out;
}

glm::dvec2 Renderer::wind_at(double x, double z, double time_s) const { return impl_->wind.at(x, z, time_s); }

void Renderer::set_wind_arrows(std::vector<scene::WindArrow> arrows) { impl_->sources().set_arrows(std::move(arrows)); }

void Renderer::set_colliders(std::vector<blades::HostSphere> spheres, double time_s) { impl_->colliders.set_host_spheres(std::move(spheres), time_s); }

void Renderer::wait_for_wind() { impl_->wind.wait(); }

std::vector<std::string> Renderer::reload_shaders() {
    std::vector<std::string> failures;
    for (auto* passes : {impl_->plain_passes.get(), impl_->aov_passes.get()}) {
        if (passes) {
            passes->reload(failures);
        }
    }
    for (auto reload : {+[](Impl& i) { i.clipmap.reload(); }, +[](Impl& i) { i.cull.reload(); }, +[](Impl& i) { i.depth_pyramid.reload(); },
                        +[](Impl& i) { if (i.simulation) { i.simulation->pass().reload(); } },
                        +[](Impl& i) { if (i.surface_simulation) { i.surface_simulation->pass().reload(); } },
                        +[](Impl& i) { if (i.mesh_ground) { i.mesh_ground->grass().reload(); } }, +[](Impl& i) { i.block_samples.reload(); }, +[](Impl& i) { i.wind.reload(); i.sources().reload(); }}) {
        try {
            reload(*impl_);
        } catch (const base::Error& error) {
            failures.emplace_back(error.what());
        }
    }
    return failures;
}

} // namespace sward::render
