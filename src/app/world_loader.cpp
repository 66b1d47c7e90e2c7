// SPDX-License-Identifier: Apache-2.0
#include "app/world_loader.h"

#include "app/io.h"
#include "app/paths.h"
#include "app/set_cache.h"
#include "app/sphere_cache.h"
#include "base/error.h"

namespace sward::app {

namespace fs = std::filesystem;

scene::Scene load_scene(const Options& options) {
    fs::path file = options.scene.empty() ? default_scene() : options.scene;
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        file /= "scene.toml";
    scene::Scene scene = scene::load_scene(file);
    if (options.density)
        scene.grass.density = *options.density;
    return scene;
}

void settle_paths(scene::Scene& scene) {
    scene::PlaceOnEarth on_earth; // made when it is first asked for
    const scene::TerrainSpec& terrain = scene.terrain;
    scene::settle_places(scene, [&](double latitude, double longitude) {
        if (!on_earth && terrain.surface.empty())
            on_earth = place_on_earth(load_elevation(terrain));
        if (!on_earth)
            throw base::input_error(base::ExitCode::kBadInput, scene.file, 0, "geo",
                                    "a latitude and longitude",
                                    "x and z: the terrain has no place on Earth");
        return on_earth(latitude, longitude);
    });
}

std::map<fs::path, scene::Mesh> load_meshes(const scene::Scene& scene) {
    std::map<fs::path, scene::Mesh> meshes;
    const auto add = [&](const fs::path& mesh) {
        if (!mesh.empty() && !meshes.contains(mesh))
            meshes.emplace(mesh, load_mesh(mesh));
    };
    for (const scene::WindObstacle& obstacle : scene.wind.obstacles)
        add(obstacle.mesh);
    for (const scene::ObjectSpec& object : scene.objects)
        add(object.mesh);
    return meshes;
}

/// What lies at time 0, by a mask: read as a density mask is, where it belongs on Earth or over the
/// whole terrain.
scene::DensityMask load_track_mask(const fs::path& mask, const scene::Heightfield& ground) {
    scene::TerrainSpec spec;
    spec.mask = mask;
    return mask.empty() ? scene::DensityMask{} : load_mask(spec, ground);
}

render::World load_world(const scene::Scene& scene, const LoadTold& told) {
    const auto tell = [&](std::string_view what) {
        if (told)
            told(what, {});
    };
    tell("meshes");
    // Quick to refuse first: a bake may take minutes.
    render::World world;
    world.scene = scene;
    world.meshes = load_meshes(scene);
    world.spheres = load_spheres(scene, world.meshes);
    if (!scene.terrain.surface.empty()) {
        world.surface = load_mesh(scene.terrain.surface); // its grass is placed
        scene::settle_places(world.scene, {});
        if (!scene.surface_grass.set.empty())
            world.grass = load_grass(scene, told);
        return world;
    }
    tell("elevation");
    world.elevation = load_elevation(scene.terrain);
    scene::settle_places(world.scene, place_on_earth(world.elevation));
    tell("mask");
    if (scene.terrain.has_mask())
        world.mask = load_mask(scene.terrain, world.elevation);
    if (scene.tracks) {
        world.lying = load_track_mask(scene.tracks->mask, world.elevation);
        world.lying_way = load_track_mask(scene.tracks->mask_way, world.elevation);
    }
    world.grass = load_grass(scene, told);
    return world;
}

} // namespace sward::app
