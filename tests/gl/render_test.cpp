// SPDX-License-Identifier: Apache-2.0
// Whole frames of a small world: complete, finite, repeatable, and gone without a trace.
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "gl/fixture.h"
#include "gl/framebuffer.h"
#include "gl/memory.h"
#include "grass/bc5.h"
#include "render/renderer.h"
#include "render/screen_passes.h"
#include "shared/tone.h"
#include "shells/far_appearance.h"

namespace sward::tests {
namespace {

using render::FrameSettings;
using render::Renderer;
using render::Tiers;

render::World small_world(scene::Heightfield field = hilly_field()) {
    render::World world;
    world.scene.terrain.detail_m = 0.3;
    world.scene.lod.handover_start_m = 3;
    world.scene.lod.handover_end_m = 7;
    world.elevation = std::move(field);
    world.mask = even_mask(1);
    world.grass = synthetic_set();
    return world;
}

FrameSettings small_frame() {
    FrameSettings settings;
    settings.width = 160;
    settings.height = 90;
    return settings;
}

class Render : public GlTest {
protected:
    static render::Moment view_from(const Renderer& renderer, glm::dvec3 position,
                                    double pitch_deg) {
        scene::Pose pose;
        pose.position = position;
        pose.pitch_deg = pitch_deg;
        pose = renderer.above_datum(pose);
        return {pose, pose, 3.5, 0};
    }
};

TEST_F(Render, OcclusionChangesNoPixel) {
    Renderer renderer(small_world());
    FrameSettings settings = small_frame();
    settings.tiers = Tiers::kBlades;
    settings.blades_distance_m = 40;
    std::uint64_t taken = 0;
    for (const double yaw : {0.0, 90.0, 180.0, 270.0}) {
        render::Moment view = view_from(renderer, {20, 0.6, 30}, 3);
        view.pose.yaw_deg = view.lod_pose.yaw_deg = yaw;
        settings.cull.occlusion = false;
        renderer.draw(view, settings);
        const scene::Picture without = renderer.read_picture();
        settings.cull.occlusion = true;
        renderer.draw(view, settings);
        EXPECT_EQ(renderer.read_picture().rgb, without.rgb) << yaw;
        taken += renderer.stats().culled_by_occlusion;
    }
    EXPECT_GT(taken, 100u); // the hills hide some
}

TEST_F(Render, AovsHoldEveryTierAndAreFinite) {
    Renderer renderer(small_world());
    FrameSettings settings = small_frame();
    settings.aov = true;
    renderer.draw(view_from(renderer, {20, 1.5, 30}, -12), settings);
    const scene::Image image =
        renderer.read_aovs({"color", "depth", "tier", "coverage", "tangent", "normal", "rank"});
    ASSERT_EQ(image.channels.size(), 14u);
    std::map<int, int> tiers;
    for (std::size_t i = 0; i < image.texels.size(); i += image.channels.size()) {
        const float* texel = &image.texels[i];
        for (std::size_t c = 0; c < image.channels.size(); ++c) {
            ASSERT_TRUE(std::isfinite(texel[c])) << image.channels[c];
        }
        ASSERT_GE(std::min({texel[0], texel[1], texel[2]}), 0.0f);
        EXPECT_EQ(texel[3], 1.0f); // alpha
        const int tier = static_cast<int>(texel[5]);
        ++tiers[tier];
        EXPECT_GE(texel[6], 0.0f);
        EXPECT_LE(texel[6], 1.0f);
        EXPECT_EQ(texel[4] > 0, tier != 7) << "only the sky has no depth";
        if (tier == 1 || tier == 2 || tier == 3 || tier == 4 || tier == 5) {
            EXPECT_NEAR(glm::length(glm::vec3(texel[7], texel[8], texel[9])), 1, 0.02);
            EXPECT_GT(texel[13], 0.0f); // rank
        }
    }
    for (const int tier : {0, 1, 3, 7}) {
        EXPECT_GT(tiers[tier], 20) << "tier " << tier;
    }
    EXPECT_GT(tiers[4] + tiers[5], 20);
    for (const auto& [tier, count] : tiers) {
        EXPECT_TRUE(std::set<int>({0, 1, 2, 3, 4, 5, 7}).count(tier)) << tier;
    }
}

TEST_F(Render, TwiceTheSameFrameIsTheSamePicture) {
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -12);
    renderer.draw(view, small_frame());
    const auto first = renderer.read_picture();
    const auto colour = renderer.read_aovs({"color", "depth"});
    renderer.draw(view_from(renderer, {400, 60, -300}, -40),
                  small_frame()); // somewhere else in between
    EXPECT_NE(renderer.read_picture().rgb, first.rgb);
    renderer.draw(view, small_frame());
    EXPECT_EQ(renderer.read_picture().rgb, first.rgb);
    EXPECT_EQ(renderer.read_aovs({"color", "depth"}).texels, colour.texels);
    Renderer other(small_world());
    other.draw(view, small_frame());
    EXPECT_EQ(other.read_picture().rgb, first.rgb);
    FrameSettings aov = small_frame();
    aov.aov = true;
    other.draw(view, aov);
    EXPECT_EQ(other.read_picture().rgb, first.rgb) << "AOVs change no colour";
}

/// Place of a pixel's first sample, in pixels from its bottom left corner: the one whose depth the
/// AOVs hold.
glm::vec2 first_sample(int samples) {
    const gl::Texture texture(GL_RGBA16F, {4, 4, 0, 1, samples});
    const gl::Framebuffer framebuffer({&texture}, nullptr);
    framebuffer.bind(4, 4);
    glm::vec2 place(0);
    glGetMultisamplefv(GL_SAMPLE_POSITION, 0, &place.x);
    return place;
}

TEST_F(Render, DepthOfFlatGroundIsTheClosedForm) {
    auto world = small_world(flat_field(250));
    world.scene.terrain.detail_m = 0;
    Renderer renderer(std::move(world));
    FrameSettings settings = small_frame();
    settings.blades = settings.shells = settings.slices = false;
    const double first = first_sample(settings.samples).y;
    const double pitch = -35, eye = 1.8;
    renderer.draw(view_from(renderer, {20, eye, 30}, pitch), settings);
    const auto depth = renderer.read_aovs({"depth"});
    const double radians = pitch * 3.14159265358979 / 180,
                 focal = 0.5 * settings.height / std::tan(0.5 * 60 * 3.14159265358979 / 180);
    for (int y = 0; y < settings.height; ++y) {
        const double up =
            (0.5 * settings.height - y - 1 + first) / focal; // of the ray, for one metre ahead
        const double falls = -(std::sin(radians) + up * std::cos(radians));
        for (const int x : {0, 80, 159}) {
            EXPECT_NEAR(depth.texels[static_cast<std::size_t>(y * settings.width + x)] /
                            (eye / falls),
                        1, 2e-3)
                << y;
        }
    }
}

/// Mean difference of two pictures, of 255.
double picture_difference(const scene::Picture& a, const scene::Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        sum += std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    }
    return sum / static_cast<double>(a.rgb.size());
}

/// The far tier alone, of a small world with this set.
scene::Picture far_picture(const grass::GrassSet& set) {
    render::World world = small_world();
    world.grass = set;
    world.far = render::FarScheme::kPlanes;
    Renderer renderer(std::move(world));
    scene::Pose pose;
    pose.position = {20, 1.5, 30};
    pose.pitch_deg = -20;
    pose = renderer.above_datum(pose);
    FrameSettings settings = small_frame();
    settings.tiers = Tiers::kShells;
    settings.far = render::FarScheme::kPlanes;
    renderer.draw({pose, pose, 3.5, 0}, settings);
    return renderer.read_picture();
}

TEST_F(Render, BlockShapesDrawWhatTheirTexelsDecodeTo) {
    grass::GrassSet set = synthetic_set();
    for (grass::FarLevel& level : set.levels) {
        for (auto& [planes, shapes] : {std::pair{&level.layers, &level.layers_shape},
                                       std::pair{&level.slices, &level.slices_shape}}) {
            *shapes = grass::empty_shapes(*planes);
            for (int i = 0; i < planes->layers / shared::kPlanes; ++i) {
                grass::compress_shape(*planes, i,
                                      *shapes); // the planes become what the blocks decode to
            }
        }
    }
    const scene::Picture blocks = far_picture(set);
    grass::GrassSet wrong = set;
    for (grass::FarLevel& level : wrong.levels) {
        for (grass::TextureArray* shapes : {&level.layers_shape, &level.slices_shape}) {
            for (auto& mip : shapes->mips) {
                std::fill(mip.begin(), mip.end(), std::uint8_t{0});
            }
        }
    }
    const scene::Picture broken = far_picture(wrong);
    for (grass::FarLevel& level : set.levels) {
        level.layers_shape = level.slices_shape = {};
    }
    const scene::Picture planes = far_picture(set);
    // The palette is finer than 8 bits: some texels change by a step.
    EXPECT_LT(picture_difference(blocks, planes), 0.2);
    EXPECT_GT(picture_difference(broken, planes), 2);
}

TEST_F(Render, StatsNameEveryPassAndCount) {
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -12);
    renderer.draw(view, small_frame());
    const auto stats = renderer.stats();
    std::vector<std::string> names;
    for (const auto& pass : stats.passes) {
        names.push_back(pass.name);
        EXPECT_GE(pass.gpu_ms, 0);
        EXPECT_LT(pass.gpu_ms, 60000);
        EXPECT_GE(pass.cpu_ms, 0);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"wind", "physics", "clipmap", "land shadow",
                                               "select blocks", "block samples", "terrain",
                                               "depth pyramid", "select blades", "cull blades",
                                               "draw blades", "sky", "resolve", "far light",
                                               "canopy", "far field", "tone map"}));
    EXPECT_GT(stats.blades_simulated, 1000u);
    EXPECT_GT(stats.physics_bytes, 16 * stats.blades_simulated);
    EXPECT_GT(stats.blades_drawn, 100u);
    EXPECT_LT(stats.blades_drawn, stats.blades_considered);
    EXPECT_GT(stats.shell_fragments + stats.slice_fragments, 1000u);
    EXPECT_GT(stats.gpu_bytes, 160u * 90 * 4 * 12);

    FrameSettings bare = small_frame();
    bare.blades = bare.shells = false;
    renderer.draw(view, bare);
    const auto fewer = renderer.stats();
    EXPECT_EQ(fewer.blades_drawn + fewer.blades_considered + fewer.shell_fragments, 0u);
    EXPECT_EQ(fewer.passes.size(), names.size() - 8);
}

TEST_F(Render, TiersDrawWhatTheirNamesSay) {
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -20);
    const auto tiers_of = [&](Tiers tiers) {
        FrameSettings settings = small_frame();
        settings.aov = true;
        settings.tiers = tiers;
        settings.blades_distance_m = settings.reference_distance_m = 12;
        settings.reference_grid = 2;
        renderer.draw(view, settings);
        const auto image = renderer.read_aovs({"tier", "coverage"});
        std::set<int> seen;
        for (std::size_t i = 0; i < image.texels.size(); i += 2) {
            seen.insert(static_cast<int>(image.texels[i]));
            EXPECT_LE(image.texels[i + 1], 1.0001f); // coverage: averaged, not added up
        }
        return seen;
    };
    EXPECT_EQ(tiers_of(Tiers::kBlades), (std::set<int>{0, 1, 2, 7}));
    EXPECT_EQ(tiers_of(Tiers::kReference), (std::set<int>{0, 1, 2, 7}));
    const auto shells = tiers_of(Tiers::kShells);
    EXPECT_TRUE((shells.count(3) || shells.count(4) || shells.count(5)) && !shells.count(2) &&
                !shells.count(1));
}

TEST_F(Render, LeavesNothingBehind) {
    const auto live_objects = [] {
        int live = 0;
        for (GLuint name = 1; name < 2000; ++name) {
            live += glIsTexture(name) + glIsBuffer(name) + glIsProgram(name) + glIsShader(name) +
                    glIsVertexArray(name) + glIsFramebuffer(name) + glIsQuery(name);
        }
        return live;
    };
    const std::uint64_t bytes = gl::gpu_bytes();
    std::vector<int> objects;
    for (int round = 0; round < 3; ++round) {
        Renderer renderer(small_world());
        FrameSettings settings = small_frame();
        for (const bool aov : {false, true}) {
            settings.aov = aov;
            renderer.draw(view_from(renderer, {20, 1.5, 30}, -12), settings);
        }
        EXPECT_GT(gl::gpu_bytes(), bytes + 1000000);
        objects.push_back(live_objects());
    }
    EXPECT_EQ(gl::gpu_bytes(), bytes);
    EXPECT_EQ(objects[2], objects[1]); // every round would add its own
    EXPECT_LT(live_objects(), 12); // drivers hold on to a program or two that were drawn with last
}

TEST_F(Render, ResizeStormLeavesNoError) {
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -12);
    FrameSettings settings = small_frame();
    const glm::ivec2 sizes[] = {{160, 90}, {1, 1}, {33, 17}, {90, 160}, {2, 120}, {160, 90}};
    std::uint64_t at_start = 0;
    for (int round = 0; round < 12; ++round) {
        settings.width = sizes[round % 6].x;
        settings.height = sizes[round % 6].y;
        settings.samples = 1 << (round % 3);
        settings.aov = round % 4 == 1;
        renderer.draw(view, settings);
        const auto picture = renderer.read_picture();
        EXPECT_EQ(picture.rgb.size(),
                  static_cast<std::size_t>(settings.width * settings.height * 3));
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << round;
        if (round == 0) {
            at_start = renderer.stats().gpu_bytes;
        }
    }
    settings = small_frame();
    settings.samples = 1;
    renderer.draw(view, settings);
    EXPECT_LT(renderer.stats().gpu_bytes, at_start + 8000000); // targets come and go
}

TEST_F(Render, OverTheLimitIsRefusedAndTheRendererLivesOn) {
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -12);
    for (const auto& [width, height, samples] :
         {std::tuple{0, 90, 4}, {160, 1 << 20, 4}, {160, 90, 0}, {160, 90, 4096}}) {
        FrameSettings settings = small_frame();
        settings.width = width;
        settings.height = height;
        settings.samples = samples;
        try {
            renderer.draw(view, settings);
            ADD_FAILURE() << width << "x" << height << " with " << samples << " samples was drawn";
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ExitCode::kOverLimit) << error.what();
        }
    }
    renderer.draw(view, small_frame());
    EXPECT_GT(renderer.stats().blades_drawn, 0u);
}

TEST_F(Render, ReloadNeedsNoRestartAndFailsSoftly) {
    const ShaderCopy shaders;
    Renderer renderer(small_world());
    const auto view = view_from(renderer, {20, 1.5, 30}, -12);
    renderer.draw(view, small_frame());
    const auto before = renderer.read_picture().rgb;
    shaders.append("lib/grass_surface.glsl", "broken\n");
    const auto failures = renderer.reload_shaders();
    forgive_messages();
    EXPECT_EQ(failures.size(), 3u); // blades; shells and slices, the planes
    for (const std::string& failure : failures) {
        EXPECT_NE(failure.find("lib/grass_surface.glsl:"), std::string::npos) << failure;
    }
    renderer.draw(view, small_frame());
    EXPECT_EQ(renderer.read_picture().rgb, before);
    shaders.restore("lib/grass_surface.glsl");
    EXPECT_TRUE(renderer.reload_shaders().empty());
    renderer.draw(view, small_frame());
    EXPECT_EQ(renderer.read_picture().rgb, before);
}

TEST_F(Render, PresentCopiesThePicture) {
    Renderer renderer(small_world());
    renderer.draw(view_from(renderer, {20, 1.5, 30}, -12), small_frame());
    const gl::Texture window(GL_RGBA8, {200, 100});
    const gl::Framebuffer framebuffer({&window}, nullptr);
    renderer.present(framebuffer.id(), 30, 5);
    const auto texels = window.read_floats(4);
    const auto picture = renderer.read_picture();
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 160; ++x) {
            const float red = texels[static_cast<std::size_t>(((y + 5) * 200 + x + 30) * 4)];
            ASSERT_NEAR(255 * red, picture.rgb[static_cast<std::size_t>(((89 - y) * 160 + x) * 3)],
                        0.01)
                << x << " " << y;
        }
    }
}

TEST_F(Render, FarAppearanceIsUsableAllOverTheHemisphere) {
    const grass::GrassSet set = synthetic_set();
    shells::FarAppearance appearance(set);
    const wind::Wind wind(SmallWorld::breeze(), 0.1);
    std::vector<float> before;
    for (const float height : {-0.1f, 0.05f, 0.6f, 1.0f}) {
        appearance.update(daylight({std::sqrt(1 - height * height), height, 0}),
                          wind.field({0, 0}, 0));
        appearance.bind();
        GLint id = 0;
        glGetIntegeri_v(GL_TEXTURE_BINDING_2D_ARRAY, TEX_FAR_APPEARANCE, &id);
        std::vector<float> texels(2 * shared::kFarWinds * 4 * shells::FarAppearance::kAzimuths *
                                  shells::FarAppearance::kElevations);
        glGetTextureImage(static_cast<GLuint>(id), 0, GL_RGBA, GL_FLOAT,
                          static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
        for (const float texel : texels) {
            ASSERT_TRUE(std::isfinite(texel) && texel >= 0) << "sun at " << height;
        }
        EXPECT_LE(texels[texels.size() / 2 - 1], 1.0f); // coverage
        EXPECT_LE(texels.back(), 1.0f);                 // mean height
        EXPECT_NE(texels, before);
        before = texels;
    }
}

// ---- screen passes

TEST_F(Render, ResolveAndToneMapOfAKnownColour) {
    render::Targets targets;
    targets.require(16, 8, 4, false);
    render::ScreenPasses passes(false);
    const glm::vec4 colours[] = {{0.5f, 0.125f, 2.0f, 1.0f}, {0.25f, 0.5f, 0.0f, 0.0f}};
    shared::FrameConstants constants{};
    constants.near_m = shared::kNear_m;
    gl::Buffer frame(sizeof(constants));
    frame.upload(&constants, sizeof(constants));
    frame.bind_uniform(BIND_FRAME);
    const float near = 0.25f; // reversed depth: kNear_m / 0.25 metres ahead
    for (int picture = 0; picture < 2; ++picture) {
        targets.bind_scene();
        glDepthMask(GL_TRUE);
        glClearBufferfv(GL_COLOR, 0, &colours[picture].x);
        glClearBufferfv(GL_DEPTH, 0, &near);
        passes.resolve(targets, 0.5f, picture == 0);
    }
    passes.tone_map(targets, 0.8f);
    const glm::vec4 mean = 0.5f * (colours[0] + colours[1]);
    const auto colour = targets.color().read_floats(4);
    const auto data = targets.data().read_floats(4);
    const auto shown = targets.picture().read_floats(4);
    const glm::vec3 expected = shared::srgb_encode(shared::tone_map(glm::vec3(mean) * 0.8f));
    for (std::size_t i = 0; i < colour.size(); i += 4) {
        for (std::size_t c = 0; c < 4; ++c) {
            EXPECT_NEAR(colour[i + c], mean[static_cast<int>(c)], 2e-3);
        }
        EXPECT_NEAR(data[i], shared::kNear_m / near, 1e-6);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(shown[i + c], expected[static_cast<int>(c)],
                        1.6 / 255); // rounding and a step of dither
        }
        EXPECT_EQ(shown[i + 3], 1.0f);
    }
}

} // namespace
} // namespace sward::tests
