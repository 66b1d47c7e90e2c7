// SPDX-License-Identifier: Apache-2.0
// One field, many views: what they share, and what a host changes while they draw.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "gl/face_fixture.h"
#include "gl/texture.h"
#include "sward/log.h"

namespace sward::tests {
namespace {

class Views : public Face {};

TEST_F(Views, TheOrderOfDrawingChangesNoPixel) {
    Field field = render::Access::field_of(face_world()),
          other = render::Access::field_of(face_world());
    const CameraPose left = pose_over(field, -15), right = pose_over(field, 15);
    CameraPose away = pose_over(field, 200, -30);
    away.position = {-400, 90, 250};
    View a(field), b(field), c(field), other_a(other), other_b(other), other_c(other);
    for (const double time_s : {1.0, 1.1}) {
        simulate(field, time_s, camera_of(left, kWidth, kHeight));
        simulate(other, time_s, camera_of(left, kWidth, kHeight));
        const Bytes first = picture(a, left), second = picture(b, right), third = picture(c, away);
        EXPECT_EQ(picture(other_c, away), third);
        EXPECT_EQ(picture(other_b, right), second);
        EXPECT_EQ(picture(other_a, left), first);
        EXPECT_EQ(picture(b, left), first) << "a view has no memory";
        EXPECT_NE(first, second);
        EXPECT_NE(second, third);
    }
}

TEST_F(Views, TwoChannelsAgreeWhereTheyOverlap) {
    Field field = render::Access::field_of(face_world());
    View left(field), right(field);
    CameraPose pose = pose_over(field);
    Camera camera = camera_of(pose, kWidth, kHeight);
    simulate(field, 1, camera);
    // Two channels of one picture plane, half a picture apart: the same rays through the overlap's
    // pixels.
    camera.clip_from_view = projection({-0.75, 0.25, -0.3125, 0.3125});
    const Bytes a = picture(left, camera);
    camera.clip_from_view = projection({-0.25, 0.75, -0.3125, 0.3125});
    const Bytes b = picture(right, camera);
    int differing = 0, most = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth / 2; ++x) {
            int apart = 0;
            for (int c = 0; c < 3; ++c) {
                apart = std::max(
                    apart,
                    std::abs(
                        static_cast<int>(
                            a[static_cast<std::size_t>(3 * (y * kWidth + x + kWidth / 2) + c)]) -
                        static_cast<int>(b[static_cast<std::size_t>(3 * (y * kWidth + x) + c)])));
            }
            differing += apart > 0 ? 1 : 0;
            most = std::max(most, apart);
        }
    }
    RecordProperty("differing_pixels", differing);
    RecordProperty("most_apart", most);
    std::printf("overlap: %d of %d pixels differ, by %d of 255 at most\n", differing,
                kWidth / 2 * kHeight, most);
    // The field is the same to the bit; a driver rounds a corner's place in the picture by where
    // the picture begins, to 1/256 pixel.
    EXPECT_LT(differing, kWidth / 2 * kHeight / 50);
}

TEST_F(Views, TenViewsCostOneSimulation) {
    Field field = render::Access::field_of(face_world());
    std::vector<View> views;
    for (int i = 0; i < 10; ++i) {
        views.emplace_back(field);
    }
    const Camera camera = camera_of(pose_over(field), kWidth, kHeight);
    simulate(field, 0.5, camera);
    const auto steps = [&] { // without the passes that views draw
        render::FrameStats stats;
        render::Access::state(field).add_stats(stats);
        return std::pair(stats.physics_steps, stats.patches_stepped);
    };
    const auto before = steps();
    const auto wind = render::Access::state(field).wind.ambient().tag().latest;
    EXPECT_EQ(before.first, 30u);
    for (View& view : views) {
        view.draw(camera, {kWidth, kHeight});
    }
    EXPECT_EQ(steps(), before);
    EXPECT_EQ(render::Access::state(field).wind.ambient().tag().latest, wind);
}

TEST_F(Views, BladesLiveAroundEveryEye) {
    Field field = render::Access::field_of(face_world());
    const double ground = field.ground_height(20, 30);
    const std::vector<glm::dvec3> eyes = {{20, ground + 1.5, 30},
                                          {80, field.ground_height(80, -40) + 1.5, -40}};
    field.simulate(0.1, {eyes.data(), 1});
    const auto one = render::Access::state(field).living()->blades();
    field.simulate(0.2, eyes);
    EXPECT_NEAR(static_cast<double>(render::Access::state(field).living()->blades()),
                2.0 * static_cast<double>(one), 0.3 * static_cast<double>(one));
    EXPECT_THROW(field.simulate(0.3, {}), Error);
}

TEST_F(Views, ASunThatMovesEndsInItsPicture) {
    render::World late = face_world();
    late.scene.sun = {210, 52};
    Field field = render::Access::field_of(face_world()),
          began = render::Access::field_of(std::move(late));
    View view(field), other(began);
    const Camera camera = camera_of(pose_over(field), kWidth, kHeight);
    simulate(field, 1, camera);
    const Bytes first = picture(view, camera);
    for (int frame = 1; frame <= 20; ++frame) {
        field.set_sun({135 + 75.0 * frame / 20, 35 + 17.0 * frame / 20});
        simulate(field, 1, camera);
        view.draw(camera, {kWidth, kHeight});
    }
    for (int frame = 0; frame < 2 * shared::kFarWinds;
         ++frame) { // the table of the march's light comes after
        simulate(field, 1, camera);
        view.draw(camera, {kWidth, kHeight});
    }
    simulate(began, 1, camera);
    EXPECT_EQ(view.read_picture(), picture(other, camera));
    EXPECT_NE(view.read_picture(), first);
    EXPECT_THROW(field.set_sun({0, 91}), Error);
}

TEST_F(Views, AWindThatChangesEndsInItsPicture) {
    constexpr double kStep_s = 0.1;
    render::World late = face_world();
    late.scene.wind.speed_mps = 9;
    late.scene.wind.direction_deg = 200;
    late.scene.wind.gust = 0.5;
    Field field = render::Access::field_of(face_world()),
          began = render::Access::field_of(std::move(late));
    View view(field), other(began);
    const Camera camera = camera_of(pose_over(field), kWidth, kHeight);
    double time_s = 0;
    glm::dvec2 before = field.wind_at(20, 30, 0);
    double leap = 0;
    for (int frame = 0; frame < 160; ++frame, time_s += kStep_s) {
        const double share = std::clamp((frame - 10) / 20.0, 0.0, 1.0);
        field.set_wind({4 + 5 * share, 270 - 70 * share, 0.4 + 0.1 * share});
        simulate(field, time_s, camera);
        simulate(began, time_s, camera);
        render::Access::state(field).wind.wait();
        const glm::dvec2 now = field.wind_at(20, 30, time_s);
        leap = std::max(leap, glm::length(now - before));
        before = now;
    }
    EXPECT_TRUE(render::Access::state(field).wind.settled());
    EXPECT_LT(leap, 0.7) << "m/s in a tenth of a second";
    for (const glm::dvec2 at : {glm::dvec2(20, 30), glm::dvec2(-300, 77), glm::dvec2(1000, -20)}) {
        render::Access::state(began).wind.wait();
        EXPECT_EQ(field.wind_at(at.x, at.y, time_s), began.wind_at(at.x, at.y, time_s));
    }
    for (int frame = 0; frame < 2 * shared::kFarWinds;
         ++frame) { // the far field's light comes after
        simulate(field, time_s, camera);
        simulate(began, time_s, camera);
        view.draw(camera, {kWidth, kHeight});
    }
    EXPECT_EQ(view.read_picture(), picture(other, camera));
    EXPECT_THROW(field.set_wind({-1, 0, 0}), Error);
}

TEST_F(Views, DensityAndObjectsAreTheHosts) {
    render::World world = face_world();
    scene::ObjectSpec ball;
    ball.kind = scene::ObjectKind::kSphere;
    ball.radius_m = 0.8;
    ball.position = {500, 0.8, 500};
    world.scene.objects = {ball};
    Field field = render::Access::field_of(std::move(world));
    View view(field);
    const CameraPose pose = pose_over(field);
    const Camera camera = camera_of(pose, kWidth, kHeight);
    simulate(field, 1, camera);
    const Bytes whole = picture(view, camera);
    field.set_density(0.1);
    const Bytes thin = picture(view, camera);
    EXPECT_NE(thin, whole);
    field.set_density(1);
    EXPECT_EQ(picture(view, camera), whole);
    glm::dmat4 place(1);
    place[3] = glm::dvec4(pose.position + glm::dvec3(0, -1, -5), 1);
    const Body body{0, place};
    field.set_objects({&body, 1}, 1);
    EXPECT_NE(picture(view, camera), whole);
    const Body none{1, place};
    EXPECT_THROW(field.set_objects({&none, 1}, 1), Error);
    EXPECT_THROW(field.set_density(2), Error);
}

// ---- cameras

double mean_apart(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    }
    return sum / static_cast<double>(a.size());
}

TEST_F(Views, MirrorAndBankShowTheSameField) {
    Field field = render::Access::field_of(face_world());
    View view(field);
    CameraPose pose = pose_over(field);
    Camera camera = camera_of(pose, kWidth, kHeight);
    simulate(field, 1, camera);
    const Bytes plain = picture(view, camera);
    Camera mirror = camera;
    mirror.clip_from_view[0][0] *= -1;
    const Bytes mirrored = picture(view, mirror);
    pose.roll_deg = 180;
    const Bytes banked = picture(view, pose);
    Bytes back = plain, turned = plain;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c) {
                const auto at = static_cast<std::size_t>(3 * (y * kWidth + x) + c);
                back[at] =
                    mirrored[static_cast<std::size_t>(3 * (y * kWidth + kWidth - 1 - x) + c)];
                turned[at] = banked[static_cast<std::size_t>(
                    3 * ((kHeight - 1 - y) * kWidth + kWidth - 1 - x) + c)];
            }
        }
    }
    // Samples and dither lie elsewhere in a pixel; another side of a hill or no grass would be tens
    // apart.
    EXPECT_LT(mean_apart(back, plain), 6);
    EXPECT_LT(mean_apart(turned, plain), 6);
    EXPECT_GT(mean_apart(mirrored, plain), 2 * mean_apart(back, plain));
}

TEST_F(Views, TheNearPlaneMovesNothingElse) {
    Field field = render::Access::field_of(face_world());
    View view(field);
    CameraPose pose = pose_over(field);
    simulate(field, 1, camera_of(pose, kWidth, kHeight));
    const Bytes plain = picture(view, pose);
    for (const double near_m : {0.01, 0.3}) {
        pose.near_m = near_m;
        EXPECT_LT(mean_apart(picture(view, pose), plain), 0.5) << near_m;
    }
    pose.near_m = 8;
    EXPECT_GT(mean_apart(picture(view, pose), plain), 1) << "what stands nearer is cut off";
}

TEST_F(Views, CamerasThatAreNoneAreRefused) {
    Field field = render::Access::field_of(face_world());
    View view(field);
    const Camera good = camera_of(pose_over(field), kWidth, kHeight);
    simulate(field, 1, good);
    const Bytes before = picture(view, good);
    std::vector<Camera> bad(5, good);
    bad[0].view_from_world[0] *= 2;        // stretches
    bad[1].clip_from_view = glm::dmat4(1); // parallel rays
    bad[2].view_from_world[3][0] = std::nan("");
    bad[3].clip_from_view[3][2] = 0; // no near plane
    bad[4].clip_from_view[0][0] = 0; // no width
    for (std::size_t i = 0; i < bad.size(); ++i) {
        try {
            view.draw(bad[i], {kWidth, kHeight});
            ADD_FAILURE() << i << " was drawn";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << error.what();
        }
    }
    EXPECT_THROW(view.draw(good, {0, kHeight}), Error);
    EXPECT_EQ(picture(view, good), before);
}

TEST_F(Views, MessagesGoToTheHost) {
    std::vector<std::pair<LogLevel, std::string>> told;
    set_log([&](LogLevel level, std::string_view text) { told.emplace_back(level, text); });
    base::log_warning("of the host's");
    base::log_debug("two\nlines");
    set_log({});
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[0], (std::pair<LogLevel, std::string>(LogLevel::kWarning, "of the host's")));
    EXPECT_EQ(told[1], (std::pair<LogLevel, std::string>(LogLevel::kDebug, "two\\nlines")));
}

TEST_F(Views, AnEyeComesBackToTheBit) {
    for (const glm::dvec3 place :
         {glm::dvec3(0, 100, 0), glm::dvec3(-4321, 17, 9876), glm::dvec3(0.5, -2, 64)}) {
        for (const double yaw : {0.0, 33.3, 199.7}) {
            EXPECT_EQ(eye_of(camera_of({place, yaw, -17.3, 12, 60, kNear_m}, 64, 48)), place)
                << yaw;
        }
    }
}

} // namespace
} // namespace sward::tests
