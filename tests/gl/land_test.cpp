// SPDX-License-Identifier: Apache-2.0
// A landcover as the tiers read it: at a border near and far agree, edges are crisp, and nothing
// stands on a road.
#include <algorithm>
#include <array>
#include <numeric>

#include "gl/fixture.h"

namespace sward::tests {
namespace {

constexpr int kSide = 512; // texels of 0.5 m
constexpr double kFirst_m = -128;

/// Dry grass 1.6 times as high west of x = -60, a lawn to x = 10, then water; across both a road of
/// 3 m along x at z = 20.25.
scene::DensityMask fields() {
    scene::DensityMask mask;
    mask.width = mask.height = kSide;
    mask.first_m = glm::dvec2(kFirst_m);
    mask.size_m = glm::dvec2(kSide * 0.5);
    mask.highest = 1.6;
    mask.heights = true;
    for (int n = 0; n < kSide * kSide; ++n) {
        const double x = kFirst_m + (n % kSide + 0.5) * 0.5, z = kFirst_m + (n / kSide + 0.5) * 0.5;
        const double road = std::clamp(0.5 + (1.5 - std::abs(z - 20.25)) / 0.5, 0.0, 1.0);
        const double water = x > 10 ? 1 - road : 0, grass = 1 - road - water;
        const double height = x < -60 ? 1.6 : 0.4, dryness = x < -60 ? 0.6 : -0.2;
        mask.density.push_back(static_cast<float>(grass));
        for (const double part : {grass * height / scene::kLandMostHeight, 0.5 + 0.5 * dryness,
                                  water, road, 0.0, 0.0, 0.0, 1 - grass})
            mask.land.push_back(static_cast<std::uint8_t>(std::lround(255 * part)));
    }
    return mask;
}

class Land : public GlTest {
protected:
    Land() : world_(flat_field(40), 0, fields(), {0, 41.5, 0}) {}

    /// Asks for a place of the world as what is `width` metres wide shows it. Returns its number.
    std::size_t ask(glm::dvec2 place, double width) {
        inputs_.emplace_back(glm::vec2(place - glm::dvec2(world_.anchor.x, world_.anchor.z)),
                             static_cast<float>(width), 0);
        return inputs_.size() - 1;
    }
    /// All that was asked for, in one program: it takes seconds to build. Density, height, dryness
    /// and asphalt of each.
    std::vector<glm::vec4> answers() const {
        return run_probe(shaders_, {"lib/ground.glsl", "lib/land_ground.glsl"},
                         "    b = vec4(mask_density(a.xy, a.z), land_height(a.xy, a.z), "
                         "land_dryness(a.xy, a.z), grounds_at(a.xy, a.z).asphalt);",
                         inputs_);
    }
    const ShaderCopy shaders_;
    SmallWorld world_;
    std::vector<glm::vec4> inputs_;
};

struct Border {
    glm::dvec2 middle, size;
};
constexpr std::array<double, 4> kWidths = {0.001, 0.05, 0.3, 1.0};
constexpr int kAlong = 64; // places of a border a side

/// The mean of places of a border.
glm::vec4 mean_from(const std::vector<glm::vec4>& found, std::size_t first) {
    const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
    return std::accumulate(begin, begin + kAlong * kAlong, glm::vec4(0)) /
           static_cast<float>(kAlong * kAlong);
}

TEST_F(Land, EveryWidthReadsTheSameField) {
    // Borders agree between tiers: 3 m across each, of which a half is the other's whatever the
    // width.
    const std::array<Border, 3> borders = {
        Border{{-20, 18.75}, {24, 3}}, Border{{-20, 21.75}, {24, 3}}, Border{{10, -30}, {3, 24}}};
    std::vector<std::size_t> means;
    for (const Border& border : borders) {
        for (const double width : kWidths) {
            means.push_back(inputs_.size());
            for (int n = 0; n < kAlong * kAlong; ++n)
                ask(border.middle +
                        border.size *
                            (glm::dvec2(n % kAlong + 0.5, n / kAlong + 0.5) / double(kAlong) - 0.5),
                    width);
        }
    }
    const std::size_t close = inputs_.size(); // over the road
    for (int n = 0; n < 4000; ++n)
        ask({-50 + 0.01 * n, 17 + 6.5 * ((n * 619) % 4000) / 4000.0}, 0.002);
    const std::size_t strip = inputs_.size(); // far away
    for (int n = 0; n < 200; ++n)
        ask({-55 + 0.3 * n, 20.25}, 8);
    const std::size_t hay = ask({-90, -40}, 0.01), lawn = ask({-20, -40}, 0.01),
                      verge = ask({-20, 18.2}, 0.01);
    const auto found = answers();

    for (std::size_t b = 0; b < borders.size(); ++b) {
        const glm::vec4 near = mean_from(found, means[b * kWidths.size()]);
        EXPECT_NEAR(near.x, 0.5, 0.03) << "border " << b;
        for (std::size_t n = 1; n < kWidths.size(); ++n) {
            const glm::vec4 wide = mean_from(found, means[b * kWidths.size() + n]);
            EXPECT_NEAR(wide.x, near.x, 0.03) << "border " << b << ", width " << kWidths[n];
            EXPECT_NEAR(wide.w, near.w, 0.03) << "border " << b << ", width " << kWidths[n];
        }
    }
    int between = 0;
    for (std::size_t n = close; n < strip; ++n) {
        EXPECT_NEAR(found[n].x + found[n].w, 1, 0.02) << "grass or asphalt, and never both";
        between += found[n].w > 0.05f && found[n].w < 0.95f ? 1 : 0;
    }
    EXPECT_LT(between, 80) << "crisp near the eye";
    for (std::size_t n = strip; n < hay; ++n)
        EXPECT_NEAR(found[n].w, 3.0 / 8, 0.12)
            << "an unbroken strip: every place of it has its share";
    EXPECT_NEAR(found[hay].y, 1.6, 0.01);
    EXPECT_NEAR(found[hay].z, 0.6, 0.01);
    EXPECT_NEAR(found[lawn].y, 0.4, 0.01);
    EXPECT_NEAR(found[lawn].z, -0.2, 0.01);
    EXPECT_NEAR(found[verge].y, 0.4, 0.02) << "beside a road, too";
}

// A blade as it is drawn, less its class's factor on its height, is as long as its set has it:
// flutter, which keeps lengths, comes before.
TEST_F(Land, ABladeIsItsClassesHeight) {
    world_.set.blades.resize(64);
    std::array<shared::BladeTile, 2> tiles = {};
    tiles[0].corner = {-100, -40}; // hay far away
    tiles[1].corner = {1, -3};     // lawn near by
    tiles[0].end = tiles[1].end = 64;
    const auto records = gl::Buffer::of(std::span<const shared::BladeRecord>(world_.set.blades));
    const auto corners = gl::Buffer::of(std::span<const shared::BladeTile>(tiles));
    records.bind_storage(BIND_BLADES);
    corners.bind_storage(BIND_BLADE_TILES);
    const gl::Buffer no_states(16), no_places(16); // nothing lives
    no_states.bind_storage(BIND_BLADE_STATES);
    no_places.bind_storage(BIND_BLADE_PLACES);
    for (int n = 0; n < 128; ++n)
        inputs_.emplace_back(n / 64, n % 64, 0, 0);
    const auto found = run_probe(
        shaders_, {"lib/blade_pose.glsl"},
        "    uvec2 which = uvec2(a.xy);\n    BladeRecord blade = tile_blade(which.x, which.y);\n"
        "    BladePose pose = blade_pose(which, blade);\n    float height = "
        "land_height(pose.root.xz, 0.0);\n"
        "    vec3 down = vec3(1.0, 1.0 / height, 1.0);\n    vec3 v1 = pose.v1 * down;\n    vec3 v2 "
        "= pose.v2 * down;\n"
        "    float arc = (2.0 * length(v2) + length(v1) + length(v2 - v1)) / 3.0;\n"
        "    b = vec4(height, arc / blade.shape.y, 0.0, 0.0);",
        inputs_);
    for (std::size_t n = 0; n < found.size(); ++n) {
        EXPECT_NEAR(found[n].x, n < 64 ? 1.6 : 0.4, 0.01) << n;
        EXPECT_NEAR(found[n].y, 1, 0.01) << n;
    }
}

} // namespace
} // namespace sward::tests
