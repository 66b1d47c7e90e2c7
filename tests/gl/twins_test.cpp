// SPDX-License-Identifier: Apache-2.0
// The shared headers compiled by GLSL give what they give compiled by C++.
#include <bit>
#include <functional>

#include "gl/fixture.h"
#include "render/atmosphere.h"
#include "shared/bend.h"
#include "shared/sky.h"
#include "shared/surface.h"
#include "shared/tone.h"
#include "terrain/land_shadow.h"

namespace sward::tests {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

class Twins : public GlTest {
protected:
    /// `count` inputs, uniform in [low, high] a component.
    static std::vector<vec4> random_inputs(vec4 low, vec4 high, int count = 512) {
        std::vector<vec4> out;
        for (int i = 0; i < count; ++i) {
            vec4 v;
            for (int c = 0; c < 4; ++c) {
                v[c] = glm::mix(
                    low[c], high[c],
                    unit_at(9, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(c)));
            }
            out.push_back(v);
        }
        return out;
    }
    void compare(const std::string& header, const std::string& body,
                 const std::vector<vec4>& inputs, float tolerance,
                 const std::function<vec4(vec4)>& cpp) {
        const auto found = run_probe(shaders_, {header}, body, inputs);
        vec4 spread(0);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const vec4 expected = cpp(inputs[i]);
            for (int c = 0; c < 4; ++c) {
                ASSERT_NEAR(found[i][c], expected[c], tolerance * (1 + std::abs(expected[c])))
                    << "input " << i << " component " << c;
            }
            spread = glm::max(spread, glm::abs(found[i] - found[0]));
        }
        EXPECT_GT(glm::length(spread),
                  10 * tolerance); // the answers vary, or the comparison shows nothing
    }
    ShaderCopy shaders_;
};

TEST_F(Twins, HashesHaveTheSameBits) {
    std::vector<vec4> inputs;
    for (int i = 0; i < 512; ++i) {
        inputs.emplace_back(i * 37 - 9000, 5000 - i * 91, 0, 0);
    }
    const auto found =
        run_probe(shaders_, {"shared/hash.h"},
                  "    ivec2 cell = ivec2(a.xy);\n    uint h = hash_ivec2(cell, 0x7e11u);\n"
                  "    b = vec4(h >> 16u, h & 0xffffu, hash_to_unit(h), tile_variant(cell, 5));",
                  inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::ivec2 cell(inputs[i]);
        const std::uint32_t h = shared::hash_ivec2(cell, 0x7e11u);
        EXPECT_EQ(found[i],
                  vec4(h >> 16, h & 0xffff, shared::hash_to_unit(h), shared::tile_variant(cell, 5)))
            << i;
    }
}

TEST_F(Twins, HandOverDecidesAlike) {
    const auto inputs = random_inputs({0, 2, 0, 0}, {1, 12, 1, 3.99f});
    const vec2 band(4, 10);
    const auto found =
        run_probe(shaders_, {"shared/lod.h"},
                  "    b = vec4(handover_near(a.x, a.y, vec2(4.0, 10.0), a.z, int(a.w)), "
                  "handover_may_be_near(a.x, a.y, vec2(4.0, 10.0), int(a.w)),\n"
                  "             pose_share(a.x, a.y, vec2(4.0, 10.0)), pixel_threshold(ivec2(a.x * "
                  "100.0, a.z * 100.0)));",
                  inputs);
    int near = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const vec4& a = inputs[i];
        const int mode = static_cast<int>(a.w);
        EXPECT_EQ(found[i].x != 0, shared::handover_near(a.x, a.y, band, a.z, mode)) << i;
        EXPECT_EQ(found[i].y != 0, shared::handover_may_be_near(a.x, a.y, band, mode)) << i;
        EXPECT_NEAR(found[i].z, shared::pose_share(a.x, a.y, band), 1e-3f) << i;
        EXPECT_EQ(found[i].w, shared::pixel_threshold(glm::ivec2(vec2(a.x, a.z) * 100.0f))) << i;
        near += found[i].x != 0;
    }
    EXPECT_GT(near, 50);
    EXPECT_LT(near, 450);
}

TEST_F(Twins, BendsAlike) {
    compare(
        "shared/bend.h", "    b = vec4(bend_arc(a.x, 0.5, a.y), bend_arc(a.x, 0.5, a.y * 0.01));",
        random_inputs({0, -1, 0, 0}, {0.5f, 1, 0, 0}), 2e-5f, [](vec4 a) {
            return vec4(shared::bend_arc(a.x, 0.5f, a.y), shared::bend_arc(a.x, 0.5f, a.y * 0.01f));
        });
    compare("shared/bend.h",
            "    vec3 v1 = vec3(0.02, 0.14, -0.01);\n    vec3 v2 = vec3(0.1, 0.25, 0.03);\n    "
            "pose_blade(v1, v2, vec4(0.29, 0.3, 0.09, a.z), a.xy);\n    b = vec4(v2, v1.y);",
            random_inputs({-9, -9, 0, 0}, {9, 9, 1, 0}), 2e-5f, [](vec4 a) {
                vec3 v1(0.02f, 0.14f, -0.01f), v2(0.1f, 0.25f, 0.03f);
                shared::pose_blade(v1, v2, vec4(0.29f, 0.3f, 0.09f, a.z), vec2(a));
                return vec4(v2, v1.y);
            });
}

TEST_F(Twins, ToneAndReliefAlike) {
    compare("shared/tone.h", "    b = vec4(srgb_encode(tone_map(a.xyz)), 0.0);",
            random_inputs(vec4(0), vec4(3)), 1e-4f,
            [](vec4 a) { return vec4(shared::srgb_encode(shared::tone_map(vec3(a))), 0); });
    compare(
        "shared/surface.h",
        "    b = vec4(relief_at(a.xy, 2.0, 0.5), gradient_noise(a.zw), catmull_rom(a, 0.3), 0.0);",
        random_inputs(vec4(-500), vec4(500)), 1e-3f, [](vec4 a) {
            return vec4(shared::relief_at(vec2(a), 2.0f, 0.5f),
                        shared::gradient_noise(vec2(a.z, a.w)), shared::catmull_rom(a, 0.3f), 0);
        });
}

TEST_F(Twins, ShadesAlike) {
    SmallWorld world(flat_field(0), 0, {}, {0, 2, 0}); // its constants hold the look and the light
    world.frame.air = render::Atmosphere(60).at(glm::normalize(glm::dvec3(0.4, 0.7, 0.3))).air;
    world.upload();
    compare("lib/frame.glsl",
            "    vec3 tangent = normalize(vec3(a.x, 1.0, a.y));\n    vec3 to_eye = "
            "normalize(vec3(a.z, 0.3, a.w));\n"
            "    GrassPoint point = GrassPoint(blade_albedo(frame.looks[0], abs(a.xy) * 0.99, 0.4, "
            "1.0), tangent, 0.6, a.x);\n"
            "    b = vec4(shade_grass(frame.looks[0], frame.light, point, to_eye), "
            "sky_radiance(to_eye).g + haze_of(900.0 * to_eye).added.b);",
            random_inputs(vec4(-1), vec4(1)), 1e-3f, [&](vec4 a) {
                const shared::FrameConstants& frame = world.frame;
                const vec3 tangent = glm::normalize(vec3(a.x, 1, a.y)),
                           to_eye = glm::normalize(vec3(a.z, 0.3f, a.w));
                const shared::GrassPoint point{
                    shared::blade_albedo(frame.looks[0], glm::abs(vec2(a)) * 0.99f, 0.4f, 1),
                    tangent, 0.6f, a.x};
                return vec4(shade_grass(frame.looks[0], frame.light, point, to_eye),
                            shared::sky_radiance(frame.air, to_eye).y +
                                shared::haze_of(frame.air, 900.0f * to_eye).added.z);
            });
}

TEST_F(Twins, LandShadowAlike) {
    SmallWorld world(hilly_field(), 0, {}, {0, 400, 0});
    const scene::Heightfield& field = world.surface.elevation();
    terrain::LandShadow shadow(field);
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.9, 0.2, 0.4));
    shadow.follow(to_sun, true);
    shadow.describe(world.frame, {world.anchor.x, world.anchor.z});
    shadow.bind();
    world.upload();
    terrain::SunSweep sweep(field);
    sweep.begin(to_sun);
    ASSERT_TRUE(sweep.advance(1000));
    compare(
        "lib/land_shadow.glsl", "    b = vec4(sun_seen(a.xy, 0.0), sun_seen(a.xy, a.z), 0.0, 0.0);",
        random_inputs({-900, -900, 0, 0}, {900, 900, 30, 1}), 0.1f, // filters know 1/256 of a texel
        [&](vec4 a) {
            const glm::dvec2 at = world.world(vec2(a)) / field.spacing_m + 32.0,
                             low = glm::floor(at);
            const vec2 f(at - low);
            const int i = static_cast<int>(low.x), j = static_cast<int>(low.y);
            const vec2 seen = glm::mix(
                glm::mix(sweep.seen_from(i, j), sweep.seen_from(i + 1, j), f.x),
                glm::mix(sweep.seen_from(i, j + 1), sweep.seen_from(i + 1, j + 1), f.x), f.y);
            return vec4(shared::sun_share(seen, 0), shared::sun_share(seen, a.z), 0, 0);
        });
}

} // namespace
} // namespace sward::tests
