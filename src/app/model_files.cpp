// SPDX-License-Identifier: Apache-2.0
#include "app/model_files.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "app/parse.h"
#include "render/world.h"

namespace sward::app {

namespace fs = std::filesystem;

fs::path find_model(const char* option, const fs::path& folder, const std::string& name) {
    std::error_code ignored;
    const fs::path shipped = folder / (name + ".toml");
    if (name.find('/') == std::string::npos && fs::exists(shipped, ignored))
        return shipped;
    if (fs::exists(name, ignored))
        return name;
    std::vector<std::string> known;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".toml")
            known.push_back(entry.path().stem().string());
    std::ranges::sort(known);
    throw option_error(
        option, name, fmt::format("a model's file, or one that ships: {}", fmt::join(known, ", ")));
}

void add_model_mesh(render::World& world, const std::string& name, const scene::Mesh& mesh,
                    const glm::dvec3& colour) {
    world.meshes.insert_or_assign(name, mesh);
    scene::ObjectSpec object;
    object.kind = scene::ObjectKind::kMesh;
    object.mesh = name;
    object.colour = colour;
    object.collides = false;
    world.scene.objects.push_back(object);
}

} // namespace sward::app
