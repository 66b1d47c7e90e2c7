// SPDX-License-Identifier: Apache-2.0
#include "render/objects.h"

namespace sward::render {

Objects::Objects(const World& world) : placed_(world.scene.objects.size()) {
    for (const scene::ObjectSpec& object : world.scene.objects) {
        if (object.kind == scene::ObjectKind::kSphere && !meshes_.contains({})) {
            meshes_.emplace(std::filesystem::path(), unit_sphere());
        }
        const auto mesh = world.meshes.find(object.mesh);
        if (!object.mesh.empty() && !meshes_.contains(object.mesh) && mesh != world.meshes.end()) {
            meshes_.emplace(object.mesh, mesh->second);
        }
    }
}

void Objects::draw(MeshPass& pass, const scene::Scene& scene, const terrain::Surface& surface,
                   glm::dvec3 anchor, double time_s) const {
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        const scene::ObjectSpec& object = scene.objects[n];
        const bool ball = object.kind == scene::ObjectKind::kSphere;
        const auto mesh = meshes_.find(ball ? std::filesystem::path() : object.mesh);
        if (mesh == meshes_.end() || (!ball && object.mesh.empty())) {
            continue; // a rotor, or a vehicle without a mesh
        }
        MeshPass::Look look;
        if (placed_[n]) {
            look.place = glm::vec3(glm::dvec3((*placed_[n])[3]) - anchor);
            look.turn = glm::mat3(glm::dmat3(*placed_[n]));
        } else {
            scene::Pose pose = scene::object_pose(object, scene.paths, time_s);
            if (pose.agl) {
                pose.position.y += surface.height(pose.position.x, pose.position.z);
            }
            look.place = glm::vec3(pose.position - anchor);
            look.turn = yaw_turn(pose.yaw_deg);
        }
        look.scale = ball ? static_cast<float>(object.radius_m) : 1;
        look.colour = glm::vec3(object.colour);
        look.bare = look.colour;
        pass.execute(mesh->second, look);
    }
}

} // namespace sward::render
