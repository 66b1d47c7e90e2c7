// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include "gl/context.h"

namespace sward::render {

namespace {

std::shared_ptr<FieldState> make_field(World world) {
    gl::require_gl45();
    return std::make_shared<FieldState>(std::move(world));
}

} // namespace

Camera camera_of_pose(const scene::Pose& pose, int width, int height) {
    return camera_of(
        CameraPose{pose.position, pose.yaw_deg, pose.pitch_deg, 0, pose.fov_deg, kNear_m}, width,
        height);
}

Renderer::Renderer(World world) : field_(make_field(std::move(world))), view_(field_) {}

void Renderer::draw(const Moment& moment, const FrameSettings& settings) {
    view_.targets.require(settings.width, settings.height, settings.samples,
                          settings.aov); // refused before the time goes on
    const Camera camera = camera_of_pose(moment.pose, settings.width, settings.height);
    FrameSettings own = settings;
    if (moment.lod_pose.position != moment.pose.position) {
        own.lod_eye = moment.lod_pose.position;
    }
    SimulationSettings simulated = settings;
    simulated.physics = settings.physics && draws_blades(settings);
    const glm::dvec3 eye = lens_of(camera).eye;
    field_->simulate(moment.time_s, {&eye, 1}, simulated);
    view_.draw(camera, own, {});
}

scene::Pose Renderer::above_datum(const scene::Pose& pose) const {
    scene::Pose out = pose;
    if (pose.agl) {
        out.position.y += ground_height(pose.position.x, pose.position.z);
        out.agl = false;
    }
    return out;
}

std::vector<std::string> Renderer::reload_shaders() {
    std::vector<std::string> failures;
    field_->reload(failures);
    view_.reload(failures);
    return failures;
}

} // namespace sward::render
