// SPDX-License-Identifier: Apache-2.0
// Tracks behind the public face: what a host asks of a place, and what its objects leave there.
#include <algorithm>
#include <cmath>
#include <limits>

#include "gl/face_fixture.h"

namespace sward::tests {
namespace {

class TracksFace : public Face {};

/// A box of a mesh, an object of the scene that the host places.
render::World yard() {
    render::World world = face_world();
    world.scene.tracks.emplace();
    scene::Mesh box;
    for (int n = 0; n < 8; ++n) {
        box.positions.emplace_back((n & 1) ? 0.7f : -0.7f, (n & 2) ? 1.0f : 0.0f,
                                   (n & 4) ? 0.7f : -0.7f);
    }
    box.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    box.normals.assign(8, {0, 1, 0});
    scene::ObjectSpec object;
    object.kind = scene::ObjectKind::kMesh;
    object.mesh = "box.glb";
    object.position = {300, 0, 300};
    world.scene.objects = {object};
    world.spheres["box.glb"].spheres = {{0, 0.5f, 0, 0.5f}}; // its corners are outside of it
    world.meshes["box.glb"] = box;
    return world;
}

TEST_F(TracksFace, AHostAsksWhatHasPassed) {
    Field field = render::Access::field_of(yard());
    const glm::dvec3 eye(20, field.ground_height(20, 30) + 2, 30);
    const auto place = [&](double x, double z, double over_m) {
        glm::dmat4 frame(1);
        frame[3] = {x, field.ground_height(x, z) + over_m, z, 1};
        return frame;
    };
    const auto length = [](glm::dvec2 v) { return std::hypot(v.x, v.y); };
    for (int n = 0; n <= 12; ++n) { // 2 m in 0.2 s, then it stays
        const double time_s = 0.1 + n / 60.0;
        const Body body{0, place(18 + n / 6.0, 30, 0)};
        field.set_objects({&body, 1}, time_s);
        field.simulate(time_s, {&eye, 1});
    }
    EXPECT_GT(length(field.tracks_at(20, 30).bend), 0.8);
    EXPECT_GT(length(field.tracks_at(20, 30).pressed), 0.5);
    EXPECT_GT(field.tracks_at(18.5, 30).pressed.x, 0.5) << "along its way, east";
    double corner = 0; // which no ball fills; on a slope some hover
    for (const double x : {19.5, 20.5}) {
        corner = std::max({corner, length(field.tracks_at(x, 29.5).pressed),
                           length(field.tracks_at(x, 30.5).pressed)});
    }
    EXPECT_GT(corner, 0.3);
    EXPECT_LE(length(field.tracks_at(20, 30).bend), 1.001);
    EXPECT_EQ(field.tracks_at(20, 40).pressed, glm::dvec2(0));
    EXPECT_EQ(field.tracks_at(-4000, 1e9).bend, glm::dvec2(0));
    const Body away{0, place(300, 300, 5)};
    field.set_objects({&away, 1}, 0.4);
    field.simulate(6, {&eye, 1});
    EXPECT_LT(length(field.tracks_at(20, 30).bend), 0.01) << "it springs back";
    EXPECT_GT(length(field.tracks_at(20, 30).pressed), 0.5) << "what is broken lies";
    EXPECT_THROW(static_cast<void>(field.tracks_at(std::nan(""), 0)), Error);
    EXPECT_THROW(static_cast<void>(field.tracks_at(0, std::numeric_limits<double>::infinity())),
                 Error);
    Field plain = render::Access::field_of(face_world());
    try {
        static_cast<void>(plain.tracks_at(0, 0));
        ADD_FAILURE() << "no tracks";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kUsage);
        EXPECT_NE(std::string(error.what()).find("[tracks]"), std::string::npos);
    }
}

} // namespace
} // namespace sward::tests
