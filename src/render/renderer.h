// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/view_state.h"

namespace sward::render {

/// When and from where one looks. Poses are above the datum here (Renderer::above_datum resolves
/// agl).
struct Moment {
    scene::Pose pose;
    scene::Pose
        lod_pose; ///< where tier selection measures distances from; equal to pose but in tests
    double time_s = 0;
    std::uint32_t frame_index = 0; ///< nothing drawn depends on it yet: there is no noise in time
};

/// The camera of a pose above the datum.
[[nodiscard]] Camera camera_of_pose(const scene::Pose& pose, int width, int height);

/// A field and one view of it, simulated and drawn by one call: for the programs, the benches and
/// the tests. A host takes <sward/field.h> and <sward/view.h>. Needs a current GL 4.5 core context
/// at construction, in every call and at destruction. Throws base::Error.
class Renderer {
public:
    explicit Renderer(World world);

    /// Simulates up to the moment, for its eye, and draws a frame into the view's own targets.
    void draw(const Moment& moment, const FrameSettings& settings);
    void present(std::uint32_t fbo, int x, int y) { view_.present(fbo, x, y); }
    [[nodiscard]] scene::Picture read_picture() { return view_.read_picture(); }
    [[nodiscard]] scene::Image read_aovs(const std::vector<std::string>& names) {
        return view_.read_aovs(names);
    }
    [[nodiscard]] FrameStats stats() { return view_.stats(); }

    /// Height of the ground surface that is drawn, metres above the datum, at local x, z (clamped
    /// to the terrain). 0 in a scene on a mesh, which may have any number of surfaces there.
    [[nodiscard]] double ground_height(double x, double z) const {
        return field_->surface.height(x, z);
    }
    /// The pose with its height above the datum (agl resolved).
    [[nodiscard]] scene::Pose above_datum(const scene::Pose& pose) const;
    [[nodiscard]] glm::dvec2 wind_at(double x, double z, double time_s) const {
        return field_->wind.at(x, z, time_s);
    }
    /// Waits until wind_at() knows the frame just drawn.
    void wait_for_wind() { field_->wind.wait(); }
    void set_wind_arrows(std::vector<scene::WindArrow> arrows) {
        field_->sources().set_arrows(std::move(arrows));
    }
    void set_colliders(std::vector<blades::HostSphere> spheres, double time_s) {
        field_->colliders.set_host_spheres(std::move(spheres), time_s);
    }
    /// Recompiles programs whose source changed; returns messages of those that failed (the old
    /// program stays).
    [[nodiscard]] std::vector<std::string> reload_shaders();

    [[nodiscard]] FieldState& field() { return *field_; }

private:
    std::shared_ptr<FieldState> field_;
    ViewState view_;
};

} // namespace sward::render
