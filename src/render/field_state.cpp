// SPDX-License-Identifier: Apache-2.0
#include "render/field_state.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "blades/blade_twin.h"
#include "render/elevation_ground.h"
#include "render/mesh_ground.h"
#include "render/pass_names.h"
#include "render/reload.h"
#include "shared/bindings.h"
#include "tracks/track_mask.h"

namespace sward::render {

namespace {

/// A scene on a mesh has level ground at its datum, which is not drawn.
World with_ground(World world) {
    if (!world.surface.triangles.empty()) {
        world.elevation = {2, 2, {1000, 1000}, {0, 0, 0, 0}, {}};
        world.mask = {};
        world.scene.terrain.detail_m = 0;
    }
    return world;
}

/// The GPU holds the images now; tens of megabytes are freed here.
void free_texels(grass::GrassSet& set) {
    set.march.columns = {};
    set.march.slabs = {};
    for (grass::FarLevel& level : set.levels) {
        level.layers.mips.clear();
        level.layers.mips.shrink_to_fit();
        level.slices.mips.clear();
        level.slices.mips.shrink_to_fit();
        level.layers_shape = level.slices_shape = {};
    }
}

std::vector<tracks::Ball> balls_of(const blades::Colliders& colliders, double time_s,
                                   double step_s) {
    std::vector<tracks::Ball> out;
    if (colliders.any()) {
        for (const blades::MovingSphere& sphere : colliders.balls_at(time_s, step_s)) {
            out.push_back({sphere.centre, sphere.before, sphere.radius_m});
        }
    }
    return out;
}

/// What touches the grass of tracks: balls, and the scene's meshes by their undersides. The
/// colliders outlive it.
tracks::Tracks::Inputs track_inputs(const World& world, const blades::Colliders& colliders,
                                    tracks::Ground ground) {
    tracks::Tracks::Inputs out{std::move(ground), [&](double time_s, double step_s) {
                                   return balls_of(colliders, time_s, step_s);
                               }};
    std::map<std::filesystem::path, std::size_t> number; // of a mesh, which many may share
    std::vector<std::size_t> mesh_of;                    // an object
    for (const scene::ObjectSpec& object : world.scene.objects) {
        mesh_of.push_back(out.meshes.size());
        const auto mesh = world.meshes.find(object.mesh);
        if (!object.collides || mesh == world.meshes.end()) {
            continue;
        }
        const auto [entry, fresh] = number.emplace(object.mesh, out.meshes.size());
        mesh_of.back() = entry->second;
        if (fresh) {
            out.meshes.push_back(&mesh->second);
        }
    }
    out.bodies = [&colliders, mesh_of, count = out.meshes.size()](double time_s, double step_s) {
        std::vector<tracks::Body> bodies;
        for (const blades::MovingMesh& mesh : colliders.meshes_at(time_s, step_s)) {
            if (mesh_of[mesh.object] < count) {
                bodies.push_back({mesh_of[mesh.object], mesh.now, mesh.before});
            }
        }
        return bodies;
    };
    return out;
}

} // namespace

FieldState::FieldState(World inputs)
    : world(with_ground(std::move(inputs))),
      response(world.grass.levels.empty() ? 0 : blades::fit_response(world.grass)),
      surface(world.elevation, world.scene.terrain.detail_m),
      posts(std::make_shared<terrain::GroundSource>(surface, world.mask)),
      atmosphere(world.scene.air.visibility_km),
      wind(world.scene.wind, response,
           std::make_unique<wind::Sources>(
               world.scene, world.meshes,
               [this](double x, double z) { return surface.height(x, z); })),
      march_textures(world.grass.march),
      far_textures(world.far == FarScheme::kMarch ? grass::GrassSet{} : world.grass),
      far_appearance(world.grass),
      colliders(world.scene, world.spheres,
                [this](double x, double z) { return surface.height(x, z); }),
      objects(world), frame_buffer_(sizeof(shared::FrameConstants)),
      march_light_(world.grass, !world.surface.triangles.empty()) {
    if (!world.surface.triangles.empty()) {
        ground = std::make_unique<MeshGround>(world.surface, world.scene,
                                              world.grass.levels.empty() ? nullptr : &world.grass);
        world.surface = {};
    } else {
        ground = std::make_unique<ElevationGround>(*this);
    }
    if (world.scene.tracks) {
        tracks = std::make_unique<tracks::Tracks>(
            world.scene, world.grass.canopy_m,
            track_inputs(world, colliders,
                         [this](double x, double z) { return surface.height(x, z); }));
        if (!world.scene.tracks->mask.empty()) {
            const std::string name = base::printable(world.scene.tracks->mask.native());
            tracks->begin_with(
                tracks::painted(*world.scene.tracks,
                                {world.lying, world.lying_way, world.elevation.extent_m(), name}),
                name);
            world.lying = world.lying_way = {};
        }
    }
    free_texels(world.grass);
}

DrawPasses& FieldState::passes(bool aov) {
    auto& slot = aov ? aov_passes_ : plain_passes_;
    if (!slot) {
        slot = std::make_unique<DrawPasses>(aov, far_textures.block_shapes(), ground->on_charts(),
                                            posts->land_frame.x > 0);
    }
    return *slot;
}

blades::LivingBlades* FieldState::wake(const SimulationSettings& settings, int eyes) {
    lives_ = settings.physics && ground->has_blades();
    if (!lives_) {
        return nullptr;
    }
    rooms_ = std::max(rooms_, eyes);
    const blades::LivingBlades::Settings wanted{
        {settings.simulated_radius_m, settings.most_simulated_bytes, rooms_}};
    const auto* present = living();
    const bool fits = present && present->settings().pages.radius_m == wanted.pages.radius_m &&
                      present->settings().pages.most_bytes == wanted.pages.most_bytes &&
                      present->settings().pages.eyes == wanted.pages.eyes;
    if (!fits) {
        ground->make_living(wanted);
    }
    return ground->living();
}

void FieldState::simulate(double time, std::span<const glm::dvec3> eyes,
                          const SimulationSettings& settings) {
    if (eyes.empty()) {
        throw base::Error(base::ExitCode::kBadInput,
                          "simulate: eyes: found none, expected one or more");
    }
    timers.begin_frame(settings.wait_in_passes);
    track(time, eyes);
    light_followed_ = shadow_followed_ = false;
    const glm::dvec3 eye = eyes.front();
    blades::LivingBlades* const alive = wake(settings, static_cast<int>(eyes.size()));
    if (!alive) {
        const gl::PassScope pass(timers, pass_names::kWind);
        wind.advance(time, {eye.x, eye.z}, settings.most_wind_steps);
        wind.bind();
    } else {
        if (!clipmap_) {
            clipmap_ = std::make_unique<terrain::Clipmap>(posts);
        }
        ground->bind_under_blades(*clipmap_, {eye.x, eye.z});
        Lens lens;
        lens.eye = eye;
        const Shot shot = make_shot(*clipmap_, lens, {}, glm::dvec2(0));
        frame_buffer_.upload(&shot.constants, sizeof(shot.constants));
        frame_buffer_.bind_uniform(BIND_FRAME);
        alive->advance(time,
                       {wind, surface, colliders, eye, shot.anchor, settings.most_physics_steps,
                        settings.most_wind_steps, &timers, eyes.subspan(1)});
    }
    time_s = time;
    eyes_.assign(eyes.begin(), eyes.end());
}

void FieldState::track(double time, std::span<const glm::dvec3> eyes) {
    if (tracks) {
        const gl::PassScope pass(timers, pass_names::kTracks);
        tracks->advance(time, eyes);
        tracks->bind();
    }
}

double FieldState::away_from_eyes(glm::dvec3 place) const {
    double least = 1e30;
    for (const glm::dvec3& eye : eyes_) {
        least = std::min(least, glm::distance(eye, place));
    }
    return least;
}

void FieldState::follow_light(const shared::Light& light, const shared::WindField& field) {
    if (light_at_once) {
        march_light_.update(light, field);
    } else if (!light_followed_) {
        march_light_.follow(light, field);
        light_followed_ = true;
    }
    march_light_.bind();
}

void FieldState::follow_shadow() {
    if (light_at_once || !shadow_followed_) {
        ground->follow_sun(to_sun(), light_at_once);
        shadow_followed_ = true;
    }
    ground->bind_shadow();
}

void FieldState::set_density(double density) {
    if (!(density >= 0 && density <= 1)) {
        throw base::Error(base::ExitCode::kBadInput,
                          fmt::format("density: found {}, expected 0 to 1", density));
    }
    if (ground->placed_for_good()) {
        throw base::Error(base::ExitCode::kUsage, "density: found a scene on a mesh, whose blades "
                                                  "are placed for good, expected one on elevation");
    }
    world.scene.grass.density = density;
}

void FieldState::check_object(std::size_t object, const glm::dmat4& world_from_object) const {
    if (object >= objects.count()) {
        throw base::Error(
            base::ExitCode::kBadInput,
            fmt::format("object: found {}, expected one of the scene's {}, counted from 0", object,
                        objects.count()));
    }
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(world_from_object[column][row])) {
                throw base::Error(base::ExitCode::kBadInput,
                                  fmt::format("object {}: found a matrix with infinity or no "
                                              "number, expected finite ones",
                                              object));
            }
        }
    }
}

void FieldState::set_object(std::size_t object, const glm::dmat4& world_from_object,
                            double when_s) {
    objects.place(object, world_from_object);
    colliders.set_body(object, world_from_object, when_s);
}

void FieldState::add_stats(FrameStats& stats) const {
    for (const auto& row : timers.rows()) {
        stats.passes.push_back({row.name, row.gpu_ms, row.cpu_ms});
    }
    if (const blades::LivingBlades* alive = living()) {
        stats.blades_simulated = alive->blades();
        stats.patches_stepped = alive->pass().stepped_patches();
        stats.physics_steps = static_cast<std::uint64_t>(alive->steps());
        stats.physics_bytes = alive->bytes();
        stats.sphere_pairs = alive->sphere_pairs();
    }
    if (tracks) {
        stats.track_pages = tracks->pages().used();
        stats.track_bytes = tracks->bytes();
        stats.track_memory_bytes = tracks->memory().bytes();
    }
    ground->add_stats(stats);
}

void DrawPasses::reload(std::vector<std::string>& failures) {
    render::reload(&terrain, failures);
    render::reload(&blades, failures);
    render::reload(&shells, failures);
    render::reload(&slices, failures);
    render::reload(&march, failures);
    render::reload(&screen, failures);
    render::reload(&meshes, failures);
    render::reload(surface_.get(), failures);
}

blades::DrawPass& DrawPasses::surface(bool aov) {
    if (!surface_) {
        surface_ = std::make_unique<blades::DrawPass>(aov, true);
    }
    return *surface_;
}

void FieldState::reload(std::vector<std::string>& failures) {
    for (auto* variant : {plain_passes_.get(), aov_passes_.get()}) {
        if (variant) {
            variant->reload(failures);
        }
    }
    ++reloads;
    render::reload(&posts->height_program, failures);
    render::reload(&posts->surface_program, failures);
    ground->reload(failures);
    render::reload(tracks.get(), failures);
    render::reload(&wind, failures);
    render::reload(&sources(), failures);
    if (clipmap_) {
        clipmap_->refill();
    }
}

} // namespace sward::render
