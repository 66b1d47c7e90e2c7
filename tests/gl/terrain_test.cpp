// SPDX-License-Identifier: Apache-2.0
// The ground on the GPU held to its CPU twin: clipmap, block samples, wind; and no holes between
// blocks or levels.
#include <cmath>
#include <map>
#include <random>

#include "gl/fixture.h"
#include "terrain/terrain_pass.h"

namespace sward::tests {
namespace {

using terrain::Clipmap;

constexpr int kCells = shared::kClipCells;

/// World index of the post that stands in a texel of a level.
glm::ivec2 post_of(const Clipmap& clipmap, int level, glm::ivec2 texel) {
    const glm::ivec2 first = clipmap.window(level).first;
    return first + ((texel - first) & (kCells - 1));
}

class Terrain : public GlTest {
protected:
    /// Texels of a level that differ by more than a millimetre from the twin.
    static int wrong_texels(const Clipmap& clipmap, const terrain::Surface& surface, int level) {
        const std::vector<float> heights = clipmap.heights().read_floats(1, level);
        const double spacing = Clipmap::spacing(level);
        int wrong = 0;
        for (int n = 0; n < kCells * kCells; ++n) {
            const glm::dvec2 place =
                glm::dvec2(post_of(clipmap, level, {n % kCells, n / kCells})) * spacing;
            wrong += !(std::abs(heights[static_cast<std::size_t>(n)] -
                                surface.height(place.x, place.y, spacing)) < 1e-3);
        }
        return wrong;
    }
};

TEST_F(Terrain, ClipmapHeightsEqualTheTwin) {
    const terrain::Surface surface(hilly_field(), 0.8);
    Clipmap clipmap(surface, {});
    clipmap.update({123.4, -321.5});
    for (const int level : {0, 1, 3, clipmap.levels() - 1}) {
        EXPECT_EQ(wrong_texels(clipmap, surface, level), 0) << "level " << level;
    }
}

TEST_F(Terrain, MovingTheEyeMovesNoPost) {
    const terrain::Surface surface(hilly_field(), 0.8);
    Clipmap clipmap(surface, {});
    clipmap.update({123.4, -321.5});
    std::vector<std::vector<float>> before;
    std::vector<glm::ivec2> windows;
    for (int level = 0; level < 3; ++level) {
        before.push_back(clipmap.heights().read_floats(1, level));
        windows.push_back(clipmap.window(level).first);
    }
    clipmap.update({123.4 + 37, -321.5 - 11});
    for (int level = 0; level < 3; ++level) {
        const glm::ivec2 old = windows[static_cast<std::size_t>(level)];
        EXPECT_NE(clipmap.window(level).first, old) << level;
        const std::vector<float> after = clipmap.heights().read_floats(1, level);
        int kept = 0, changed = 0;
        for (int n = 0; n < kCells * kCells; ++n) {
            const glm::ivec2 offset = post_of(clipmap, level, {n % kCells, n / kCells}) - old;
            if (offset.x >= 0 && offset.y >= 0 && offset.x < kCells && offset.y < kCells) {
                ++kept;
                changed += before[static_cast<std::size_t>(level)][static_cast<std::size_t>(n)] !=
                           after[static_cast<std::size_t>(n)];
            }
        }
        EXPECT_GT(kept, kCells * kCells / 8) << level;
        EXPECT_EQ(changed, 0) << level;
        EXPECT_EQ(wrong_texels(clipmap, surface, level), 0) << level;
    }
}

TEST_F(Terrain, WindowsHoldTheEyeAndNestOnBlocks) {
    const terrain::Surface surface(hilly_field(), 0);
    Clipmap clipmap(surface, {});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> metres(-3000, 3000);
    for (int n = 0; n < 20; ++n) {
        const glm::dvec2 eye(metres(random), metres(random));
        clipmap.update(eye);
        for (int level = 0; level < clipmap.levels(); ++level) {
            const glm::dvec2 cells =
                eye / Clipmap::spacing(level) - glm::dvec2(clipmap.window(level).first);
            EXPECT_GE(std::min(cells.x, cells.y),
                      56.0); // ground.glsl leaves a level 54 cells from the eye
            EXPECT_LE(std::max(cells.x, cells.y), kCells - 56.0);
            if (level > 0) {
                const glm::ivec2 hole =
                    clipmap.window(level - 1).first - 2 * clipmap.window(level).first;
                EXPECT_EQ(hole.x % (2 * shared::kBlockCells), 0);
                EXPECT_EQ(hole.y % (2 * shared::kBlockCells), 0);
            }
        }
    }
}

TEST_F(Terrain, GroundIsContinuousAcrossLevels) {
    SmallWorld world(hilly_field(), 0.8, {}, {123.4, 330, -321.5});
    const ShaderCopy shaders;
    constexpr int kSteps = 20000;
    constexpr float kStep_m = 0.02f;
    std::vector<glm::vec4> places;
    for (const glm::vec2& way : {glm::vec2(1, 0), glm::normalize(glm::vec2(-1, 0.7f))}) {
        for (int i = 0; i < kSteps; ++i) {
            const glm::vec2 place = glm::vec2(world.frame.eye.x, world.frame.eye.z) +
                                    way * (kStep_m * static_cast<float>(i));
            places.emplace_back(place, 0, 0);
        }
    }
    const auto ground = run_probe(shaders, {"lib/ground.glsl"},
                                  "    ClipPlace place = clip_place(a.xy);\n    b = "
                                  "vec4(ground_at(a.xy), place.level, place.blend, 0.0);",
                                  places);
    int last_level = 0;
    for (std::size_t i = 1; i < ground.size(); ++i) {
        if (i == kSteps) {
            continue;
        }
        // Slopes stay below 1.5; samplers may resolve a cell to 1 / 256 only.
        const double cell = Clipmap::spacing(static_cast<int>(ground[i].y));
        ASSERT_LT(std::abs(ground[i].x - ground[i - 1].x), 1.5 * (kStep_m + cell / 256) + 1e-3)
            << "at step " << i << " level " << ground[i].y;
        last_level = std::max(last_level, static_cast<int>(ground[i].y));
        if (ground[i].y == 0 && ground[i].z == 0) {
            const glm::dvec2 at = world.world(glm::vec2(places[i]));
            ASSERT_NEAR(ground[i].x + world.anchor.y, world.surface.height(at.x, at.y), 0.1)
                << i; // between posts half a metre apart
        }
    }
    EXPECT_GE(last_level, 3); // borders were crossed
}

/// A bare strip of 8 m in a mask of 1 m, far from the eye: the clipmap's posts there are wider than
/// it.
scene::DensityMask striped_mask(bool bounded) {
    scene::DensityMask mask;
    mask.width = 1500;
    mask.height = 500;
    for (int n = 0; n < mask.width * mask.height; ++n)
        mask.density.push_back(n % mask.width >= 700 && n % mask.width < 708 ? 0.0f : 1.0f);
    mask.first_m = {-700, -1200};
    mask.size_m = {1500, 500};
    mask.bounded = bounded;
    return mask;
}

TEST_F(Terrain, TheMaskIsReadByThePixel) {
    const ShaderCopy shaders;
    for (const bool bounded : {true, false}) {
        SmallWorld world(hilly_field(), 0, striped_mask(bounded), {4, 330, -400});
        std::vector<glm::vec4> places;
        const auto add = [&](double x, double z) {
            places.emplace_back(
                glm::vec2(glm::dvec2(x, z) - glm::dvec2(world.anchor.x, world.anchor.z)), 0, 0);
        };
        for (int step = 0; step < 100; ++step) // along the strip, and to both sides of it
            add(4, -850 - 3 * step), add(-8, -850 - 3 * step), add(16, -850 - 3 * step);
        add(-900, -900), add(4, 400); // outside
        const auto read = [&](const char* width) {
            return run_probe(
                shaders, {"lib/ground.glsl"},
                std::string("    b = vec4(ground_surface(a.xy, ") + width + ").density);", places);
        };
        const auto pixel = read("0.0");
        for (std::size_t i = 0; i < 300; i += 3) {
            ASSERT_LT(pixel[i].x, 0.05) << i; // a pixel is one to two metres here
            ASSERT_GT(pixel[i + 1].x, 0.95) << i;
            ASSERT_GT(pixel[i + 2].x, 0.95) << i;
        }
        EXPECT_EQ(pixel[300].x, bounded ? 0 : 1) << "outside the mask";
        EXPECT_NEAR(pixel[301].x, bounded ? 0 : 0, 0.05);
        const auto wide = read("64.0");
        EXPECT_NEAR(wide[0].x, 1 - 8 / 64.0, 0.08) << "the share that is left of a wider one";
    }
}

/// Every point of the ground in view belongs to exactly one block.
TEST_F(Terrain, BlocksCoverTheGroundOnce) {
    SmallWorld world(hilly_field(), 0.8, {}, {123.4, 345, -321.5});
    const terrain::Frustum frustum(world.frame.clip_from_world);
    const auto blocks = visible_blocks(world.clipmap, world.surface, frustum, world.anchor,
                                       {world.frame.eye, 0.0f});
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    int seen = 0;
    for (int n = 0; n < 4000; ++n) {
        const float reach = std::pow(10.0f, 1.9f + 1.0f * unit(random));
        const glm::vec2 place = glm::vec2(world.frame.eye.x, world.frame.eye.z) +
                                reach * glm::vec2(unit(random), unit(random));
        const glm::dvec2 at = world.world(place);
        const double y = world.surface.height(at.x, at.y) - world.anchor.y;
        const glm::vec4 clip = world.frame.clip_from_world * glm::vec4(place.x, y, place.y, 1);
        if (clip.w <= 0 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) {
            continue;
        }
        int holders = 0;
        for (const terrain::VisibleBlock& block : blocks) {
            const glm::vec2 inside = (place - block.corner) / (block.cell * shared::kBlockCells);
            const bool holds = inside.x >= 0 && inside.y >= 0 && inside.x < 1 && inside.y < 1;
            holders += holds;
            if (holds) {
                EXPECT_GE(y, block.low);
                EXPECT_LE(y, block.high);
            }
        }
        ++seen;
        ASSERT_EQ(holders, 1) << place.x << " " << place.y;
    }
    EXPECT_GT(seen, 300);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        EXPECT_LE(blocks[i - 1].nearest, blocks[i].nearest);
    }
}

std::vector<shared::BlockSample> read_samples(std::size_t blocks) {
    GLint id = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, BIND_BLOCK_SAMPLES, &id);
    std::vector<shared::BlockSample> samples(blocks * shared::kBlockPosts);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(static_cast<GLuint>(id), 0,
                            static_cast<GLsizeiptr>(samples.size() * sizeof(samples[0])),
                            samples.data());
    return samples;
}

std::vector<terrain::VisibleBlock> all_blocks(const SmallWorld& world) {
    const terrain::Frustum everything(
        glm::mat4({1e-5f, 0, 0, 0}, {0, 1e-5f, 0, 0}, {0, 0, 1e-5f, 0}, {0, 0, 0, 1}));
    return visible_blocks(world.clipmap, world.surface, everything, world.anchor,
                          {world.frame.eye, 0.0f});
}

/// Where a level meets the next, every second vertex lies on the middle of a coarser edge: there
/// must be no crack.
void expect_no_cracks(const std::vector<terrain::VisibleBlock>& blocks, bool fine_ground) {
    terrain::BlockSamples pass;
    pass.execute(blocks, fine_ground);
    const auto samples = read_samples(blocks.size());
    std::map<std::tuple<int, long, long>, float> heights; // level, place in centimetres
    const auto key = [](int level, glm::vec2 place) {
        return std::tuple(level, std::lround(100.0 * place.x), std::lround(100.0 * place.y));
    };
    const auto place_of = [&](std::size_t n) {
        const terrain::VisibleBlock& block = blocks[n / shared::kBlockPosts];
        const int post = static_cast<int>(n % shared::kBlockPosts);
        return block.corner + block.cell * glm::vec2(post % 9, post / 9);
    };
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const auto [it, fresh] = heights.emplace(
            key(blocks[n / shared::kBlockPosts].level, place_of(n)), samples[n].height_m);
        ASSERT_TRUE(fresh || it->second == samples[n].height_m) << "blocks of one level disagree";
    }
    int corners = 0, middles = 0;
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const terrain::VisibleBlock& block = blocks[n / shared::kBlockPosts];
        const glm::vec2 place = place_of(n);
        if (const auto fine = heights.find(key(block.level - 1, place)); fine != heights.end()) {
            ASSERT_NEAR(fine->second, samples[n].height_m, 1e-3) << "level " << block.level;
            ++corners;
        }
        for (const glm::vec2& step : {glm::vec2(block.cell, 0), glm::vec2(0, block.cell)}) {
            const auto fine = heights.find(key(block.level - 1, place + 0.5f * step));
            const auto next = heights.find(key(block.level, place + step));
            if (fine != heights.end() && next != heights.end()) {
                ASSERT_NEAR(fine->second, 0.5 * (samples[n].height_m + next->second), 2e-3)
                    << "level " << block.level;
                ++middles;
            }
        }
    }
    EXPECT_GT(corners, 4 * 64);
    EXPECT_GT(middles, 4 * 64);
}

TEST_F(Terrain, LevelsMeetWithoutCracks) {
    SmallWorld world(hilly_field(), 2.5, {}, {131.4, 345, -317.5});
    expect_no_cracks(all_blocks(world), false);
}

/// Through a long lens the same holds, and where it begins the ground is the clipmap's.
TEST_F(Terrain, FineLevelsMeetWithoutCracks) {
    SmallWorld world(hilly_field(), 2.5, {}, {131.4, 345, -317.5});
    const terrain::Frustum everything(
        glm::mat4({1e-5f, 0, 0, 0}, {0, 1e-5f, 0, 0}, {0, 0, 1e-5f, 0}, {0, 0, 0, 1}));
    terrain::Detail detail{60, 8};
    const auto blocks = visible_blocks(world.clipmap, world.surface, everything, world.anchor,
                                       {world.frame.eye, 0.0f}, detail);
    EXPECT_GT(blocks.size(), all_blocks(world).size());
    EXPECT_LT(blocks.size(), 8193u);
    EXPECT_GE(detail.zoom, 2.0f);
    world.clipmap.bind_posts({world.anchor.x, world.anchor.z}, detail);
    expect_no_cracks(blocks, true);
}

TEST_F(Terrain, BlockSamplesEqualSurfaceAndWind) {
    SmallWorld world(hilly_field(), 0.8, even_mask(0.25f), {123.4, 345, -321.5});
    world.frame.density_scale = 0.8f; // the scene's density
    world.upload();
    const auto blocks = all_blocks(world);
    EXPECT_EQ(blocks.size(),
              256u + 192u * static_cast<std::size_t>(world.clipmap.levels() -
                                                     1)); // a quarter is the finer level's
    terrain::BlockSamples pass;
    pass.execute(blocks);
    const auto samples = read_samples(blocks.size());
    std::vector<int> checked(static_cast<std::size_t>(world.clipmap.levels()));
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const terrain::VisibleBlock& block = blocks[n / shared::kBlockPosts];
        const int post = static_cast<int>(n % shared::kBlockPosts);
        const glm::vec2 place = block.corner + block.cell * glm::vec2(post % 9, post / 9);
        const glm::dvec2 at = world.world(place);
        const glm::dvec2 wind = world.wind.at(at.x, at.y, SmallWorld::kTime_s);
        const shared::BlockSample& sample = samples[n];
        ASSERT_LT(glm::length(glm::dvec2(sample.wind) - wind), 5e-3) << place.x << " " << place.y;
        ASSERT_NEAR(sample.density, 0.8f * 64 / 255, 2e-3);
        const glm::vec2 from_eye =
            glm::abs(place - glm::vec2(world.frame.eye.x, world.frame.eye.z)) / block.cell;
        const float cells = std::max(from_eye.x, from_eye.y);
        if (cells > 39 || (block.level > 0 && cells < 28)) {
            continue; // a blend of two levels, or another level's ground
        }
        ASSERT_NEAR(sample.height_m + world.anchor.y, world.surface.height(at.x, at.y, block.cell),
                    2e-3)
            << "level " << block.level;
        ++checked[static_cast<std::size_t>(block.level)];
        if (block.level == 0) {
            const glm::vec3 normal = world.surface.normal(at.x, at.y);
            ASSERT_NEAR(sample.sun_cosine, glm::dot(normal, world.frame.light.to_sun), 0.02);
            ASSERT_NEAR(sample.slope.x, -normal.x / normal.y, 0.03);
            ASSERT_NEAR(sample.slope.y, -normal.z / normal.y, 0.03);
        }
    }
    for (int level = 0; level < 4; ++level) {
        EXPECT_GT(checked[static_cast<std::size_t>(level)], 100) << level;
    }
}

TEST_F(Terrain, WindAtEqualsTheTwin) {
    SmallWorld world(flat_field(10), 0, {}, {-4321.1, 12, 2222.2});
    const ShaderCopy shaders;
    std::vector<glm::vec4> places;
    for (int i = 0; i < 512; ++i) {
        places.emplace_back(-150 + 300 * unit_at(1, static_cast<std::uint64_t>(i), 2),
                            -150 + 300 * unit_at(1, static_cast<std::uint64_t>(i), 3), 0, 0);
    }
    const auto found = run_probe(shaders, {"lib/wind.glsl"}, "    b.xy = wind_at(a.xy);", places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec2 at = world.world(glm::vec2(places[i]));
        const glm::dvec2 wind = world.wind.at(at.x, at.y, SmallWorld::kTime_s);
        EXPECT_LT(glm::length(glm::dvec2(found[i]) - wind), 1e-3 * glm::length(wind)) << i;
    }
}

} // namespace
} // namespace sward::tests
