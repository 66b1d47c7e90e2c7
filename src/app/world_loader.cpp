// SPDX-License-Identifier: Apache-2.0
#include "app/world_loader.h"

#include "app/io.h"
#include "app/paths.h"
#include "app/set_cache.h"
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

std::map<fs::path, scene::Mesh> load_meshes(const scene::Scene& scene) {
    std::map<fs::path, scene::Mesh> meshes;
    for (const scene::WindObstacle& obstacle : scene.wind.obstacles)
        if (!obstacle.mesh.empty() && !meshes.contains(obstacle.mesh))
            meshes.emplace(obstacle.mesh, load_mesh(obstacle.mesh));
    return meshes;
}

render::World load_world(const scene::Scene& scene) {
    // Quick to refuse first: a bake may take minutes.
    render::World world;
    world.scene = scene;
    if (scene.terrain.elevation.empty())
        throw base::input_error(base::ExitCode::kBadInput, scene.file, 0, "terrain.surface", "a mesh alone",
                                "terrain.elevation (grass on meshes is not built yet)");
    world.elevation = load_elevation(scene.terrain);
    if (!scene.terrain.mask.empty())
        world.mask = load_mask(scene.terrain);
    world.meshes = load_meshes(scene);
    world.grass = load_grass(scene);
    return world;
}

} // namespace sward::app
