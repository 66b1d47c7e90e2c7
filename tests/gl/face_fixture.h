// SPDX-License-Identifier: Apache-2.0
// A small field behind the public face, and cameras over it.
#pragma once

#include <cmath>
#include <vector>

#include "gl/fixture.h"
#include "render/access.h"
#include "sward/view.h"

namespace sward::tests {

inline constexpr int kWidth = 128, kHeight = 80;

inline render::World face_world() {
    render::World world;
    world.scene.terrain.detail_m = 0.3;
    world.scene.lod.handover_start_m = 3;
    world.scene.lod.handover_end_m = 7;
    world.elevation = hilly_field();
    world.mask = even_mask(1);
    world.grass = synthetic_set();
    return world;
}

class Face : public GlTest {
protected:
    using Bytes = std::vector<std::uint8_t>;

    static CameraPose pose_over(const Field& field, double yaw_deg = 0, double pitch_deg = -12) {
        CameraPose pose;
        pose.position = {20, field.ground_height(20, 30) + 1.5, 30};
        pose.yaw_deg = yaw_deg;
        pose.pitch_deg = pitch_deg;
        return pose;
    }
    static void simulate(Field& field, double time_s, const Camera& camera) {
        const glm::dvec3 eye = eye_of(camera);
        field.simulate(time_s, {&eye, 1});
    }
    static Bytes picture(View& view, const Camera& camera) {
        view.draw(camera, {kWidth, kHeight});
        return view.read_picture();
    }
    static Bytes picture(View& view, const CameraPose& pose) {
        return picture(view, camera_of(pose, kWidth, kHeight));
    }
};

} // namespace sward::tests
