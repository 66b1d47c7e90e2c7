// SPDX-License-Identifier: Apache-2.0
#include "app/poses.h"

#include <map>

#include <fmt/format.h>

#include "app/parse.h"

namespace sward::app {
namespace {

constexpr std::size_t kListLimit = 200; // bytes: a message stays one readable line

template<class T>
std::string list_names(const std::map<std::string, T>& named, const scene::Scene& scene) {
    std::string names;
    for (const auto& [name, value] : named)
        names += (names.empty() ? "" : ", ") + name;
    return fmt::format("{} has {}", base::printable(scene.file.native(), kListLimit),
                       names.empty() ? "none" : base::printable(names, kListLimit));
}

} // namespace

scene::Pose find_camera(const scene::Scene& scene, const std::string& camera) {
    if (camera.find(',') != std::string::npos)
        return scene::parse_pose(camera, "--camera");
    if (!camera.empty()) {
        const auto found = scene.cameras.find(camera);
        if (found == scene.cameras.end())
            throw option_error("--camera", camera,
                               fmt::format("x,y,z,yaw,pitch or a camera of the scene ({})",
                                           list_names(scene.cameras, scene)));
        return found->second;
    }
    for (const char* const name : {"default", "road"})
        if (const auto chosen = scene.cameras.find(name); chosen != scene.cameras.end())
            return chosen->second;
    return scene.cameras.empty() ? scene::Pose{} : scene.cameras.begin()->second;
}

const scene::Path& find_path(const scene::Scene& scene, const std::string& name) {
    const auto found = scene.paths.find(name);
    if (found == scene.paths.end())
        throw option_error("--path", name,
                           fmt::format("a path of the scene ({})", list_names(scene.paths, scene)));
    return found->second;
}

} // namespace sward::app
