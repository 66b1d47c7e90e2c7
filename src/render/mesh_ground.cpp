// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_ground.h"

#include <cmath>
#include <numbers>

#include "render/impl.h"

namespace sward::render {

namespace {

constexpr float kApart = 0.004f;      // canopies: nearer along a ray, two of its surfaces are one
constexpr float kNoHandover_m = 1e6f; // geometry at every distance

} // namespace

MeshGround::MeshGround(const scene::Mesh& mesh, const scene::Scene& scene, const grass::GrassSet* set)
    : spec_(scene.surface_grass), mesh_(mesh),
      grass_(set ? blades::place_set_on_surface(mesh, {*set, scene.grass.density, spec_.slope_deg}, scene.terrain.surface)
                 : blades::place_surface_grass(mesh, spec_, scene.terrain.surface),
             spec_, set),
      canopy_(set ? std::make_unique<shells::SurfaceCanopy>(mesh, spec_.slope_deg) : nullptr) {}

MeshPass::Look MeshGround::look(glm::vec3 origin) const {
    MeshPass::Look look;
    look.place = origin;
    look.colour = glm::vec3(spec_.ground_colour);
    look.tier = 0;
    look.bare = glm::vec3(spec_.bare_colour);
    look.least_up = spec_.slope_deg >= 180 ? -2.0f : static_cast<float>(std::cos(spec_.slope_deg * std::numbers::pi / 180));
    look.density = 1;
    return look;
}

void MeshGround::describe(shared::FrameConstants& frame, bool far_field) const {
    if (!has_set() || !far_field) {
        frame.handover.x = kNoHandover_m;
        frame.handover.y = 1.001f * kNoHandover_m;
    }
    if (has_set()) {
        frame.patch_grid.x = frame.patch_grid.y = 0;
        frame.patch_tile.x = frame.patch_tile.y = 0;
        return;
    }
    shared::GrassAppearance& look = frame.looks[0];
    look.root = glm::vec4(glm::vec3(spec_.root_colour), spec_.dry_share);
    look.tip = glm::vec4(glm::vec3(spec_.tip_colour), spec_.variation);
    look.dry = glm::vec4(glm::vec3(spec_.dry_colour), spec_.translucency);
    look.light = {1, 1, 0.06f, 18}; // the presets'
    look.outline = {2, 1, 1, 1};
    frame.patch_grid.w = static_cast<float>(spec_.blade_height_m.y);
    frame.pose_band.w = static_cast<float>(mean_blade_width_m());
}

void Renderer::Impl::draw_mesh_ground(const FrameSettings& settings, const Shot& shot) {
    DrawPasses& draw = passes(settings.aov);
    const glm::vec3 origin(-shot.anchor);
    if (settings.terrain) {
        const gl::PassScope pass(timers, "surface");
        draw.meshes.execute(mesh_ground->mesh(), mesh_ground->look(origin));
    }
    if (!settings.blades || settings.tiers == Tiers::kShells) {
        return;
    }
    build_pyramid(settings);
    const blades::CullTests tests = settings.tiers == Tiers::kReference ? blades::CullTests{true, false, false, false} : settings.cull;
    mesh_ground->grass().limit(glm::vec3(shot.constants.lod_eye), shot.constants.handover.y);
    mesh_ground->grass().execute(terrain::Frustum(shot.constants.clip_from_world), origin, draw.surface(settings.aov), tests,
                                 counts.blades_considered > 0, living(settings) ? surface_simulation.get() : nullptr, [&](const char* name, auto&& step) {
                                     const gl::PassScope pass(timers, name);
                                     step();
                                 });
    counts.blades_considered = mesh_ground->grass().considered();
}

void Renderer::Impl::draw_mesh_far(const FrameSettings& settings, const Shot& shot) {
    if (!mesh_ground->has_set()) {
        return;
    }
    shells::MarchPass& march = passes(settings.aov).march;
    const glm::vec3 origin(-shot.anchor);
    {
        const gl::PassScope pass(timers, "canopy");
        surface_canopy.require(settings.width, settings.height);
        march_textures.bind();
        march.draw_surface(surface_canopy, mesh_ground->canopy(), origin, kApart * world.grass.canopy_m);
    }
    const shells::MarchPass::Inputs inputs{march_textures, surface_canopy.first, &surface_canopy, origin, targets.samples(), 0};
    const gl::PassScope pass(timers, "far field");
    targets.bind_resolved();
    march.choose(inputs);
    targets.bind_scene_textures();
    march.execute(inputs);
}

void Renderer::Impl::draw_objects(const FrameSettings& settings, const Shot& shot, double time_s) {
    if (world.scene.objects.empty()) {
        return;
    }
    const gl::PassScope pass(timers, "objects");
    for (const scene::ObjectSpec& object : world.scene.objects) {
        const bool ball = object.kind == "sphere";
        const auto mesh = object_meshes.find(object.mesh);
        if (!ball && mesh == object_meshes.end()) {
            continue; // a rotor, or a vehicle without a mesh
        }
        scene::Pose pose = scene::object_pose(object, world.scene.paths, time_s);
        if (pose.agl) {
            pose.position.y += surface.height(pose.position.x, pose.position.z);
        }
        MeshPass::Look look;
        look.place = glm::vec3(pose.position - shot.anchor);
        look.scale = ball ? static_cast<float>(object.radius_m) : 1;
        look.yaw_deg = pose.yaw_deg;
        look.colour = glm::vec3(object.colour);
        look.bare = look.colour;
        passes(settings.aov).meshes.execute(ball ? object_meshes.at({}) : mesh->second, look);
    }
}

void Renderer::Impl::make_object_meshes() {
    for (const scene::ObjectSpec& object : world.scene.objects) {
        if (object.kind == "sphere" && !object_meshes.contains({})) {
            object_meshes.emplace(std::filesystem::path(), unit_sphere());
        }
        const auto mesh = world.meshes.find(object.mesh);
        if (!object.mesh.empty() && !object_meshes.contains(object.mesh) && mesh != world.meshes.end()) {
            object_meshes.emplace(object.mesh, mesh->second);
        }
    }
}

} // namespace sward::render
