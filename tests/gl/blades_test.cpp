// SPDX-License-Identifier: Apache-2.0
// Near blades: what the cull pass keeps and what the tessellator makes, against the same functions
// in C++.
#include <cmath>
#include <map>
#include <set>

#include "blades/cull_pass.h"
#include "blades/depth_pyramid.h"
#include "gl/fixture.h"
#include "gl/framebuffer.h"
#include "gl/shader_source.h"
#include "shared/bend.h"
#include "shared/tile_lie.h"

namespace sward::tests {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;
using shared::BladeRecord;
using Survivors = std::vector<glm::uvec2>;

constexpr double kGround_m = 100;

class Blades : public GlTest {
protected:
    explicit Blades(float density = 1)
        : world_(flat_field(kGround_m), 0, even_mask(density), {70.3, kGround_m + 1.6, -121.7}),
          records_(gl::Buffer::of(std::span<const BladeRecord>(world_.set.blades))) {}

    void select() {
        list_ = blades::select_tiles(world_.set, world_.surface,
                                     terrain::Frustum(world_.frame.clip_from_world),
                                     {world_.anchor, world_.frame.lod_eye,
                                      world_.frame.handover_band, world_.frame.handover_mode});
        cull_.upload(list_);
    }
    /// Survivors in the order of the draw.
    Survivors cull(const blades::CullTests& tests = {.occlusion = false}) {
        records_.bind_storage(BIND_BLADES);
        EXPECT_EQ(cull_.batches(), 1u);
        cull_.execute(0, tests);
        Survivors out;
        places_.clear();
        const auto all =
            cull_.survivors().read_all<glm::uvec2>(blades::CullPass::kBatch * CULL_GROUP);
        for (const auto& command : cull_.commands().read_all<shared::DrawCommand>(
                 static_cast<std::size_t>(cull_.command_count()))) {
            EXPECT_EQ(command.instances, 1u);
            EXPECT_EQ(command.base_instance, 0u);
            EXPECT_LE(command.vertices, static_cast<unsigned>(CULL_GROUP));
            for (unsigned n = command.first; n < command.first + command.vertices; ++n) {
                out.push_back(all[n]);
                places_.push_back(static_cast<int>(n));
            }
        }
        return out;
    }
    /// A blade as it lies on its tile.
    [[nodiscard]] BladeRecord laid(glm::uvec2 which) const {
        return shared::lay_blade(list_.tiles[which.x].lie, world_.set.blades[which.y],
                                 world_.set.side_m);
    }
    [[nodiscard]] vec3 root(glm::uvec2 which) const {
        const vec2 xz = list_.tiles[which.x].corner + vec2(laid(which).root);
        return {xz.x, static_cast<float>(kGround_m - world_.anchor.y), xz.y};
    }

    SmallWorld world_;
    gl::Buffer records_;
    blades::TileList list_;
    blades::CullPass cull_;
    std::vector<int> places_; ///< of the survivors in their buffer
};

/// Distance by which a blade is inside (positive) or outside the sphere test of cull.comp, in clip
/// units.
float view_margin(const glm::mat4& clip_from_world, vec3 root, float reach) {
    const vec4 clip = clip_from_world * vec4(root, 1);
    const glm::mat4 rows = glm::transpose(clip_from_world);
    return std::min({clip.w + reach,
                     clip.w + reach * (1 + glm::length(vec3(rows[0]))) - std::abs(clip.x),
                     clip.w + reach * (1 + glm::length(vec3(rows[1]))) - std::abs(clip.y)});
}

class Cull : public Blades {
protected:
    explicit Cull(float density = 1) : Blades(density) {}
    /// Compares with a brute force over everything the list holds; decisions on a knife's edge may
    /// fall either way.
    void expect_brute_force(const Survivors& survivors, float density) {
        std::set<std::pair<unsigned, unsigned>> kept;
        for (const glm::uvec2& s : survivors) {
            EXPECT_TRUE(kept.emplace(s.x, s.y).second) << "twice";
        }
        int expected = 0;
        for (const glm::uvec2& item : list_.items) {
            for (unsigned b = item.y; b < std::min(item.y + CULL_GROUP, list_.tiles[item.x].end);
                 ++b) {
                const BladeRecord blade = laid({item.x, b});
                const vec3 at = root({item.x, b});
                const vec2 band = world_.frame.handover_band;
                const float d = glm::distance(at, world_.frame.lod_eye),
                            margin = view_margin(world_.frame.clip_from_world, at, blade.shape.y);
                const auto near = [&](float distance) {
                    return shared::handover_may_be_near(blade.root.z, distance, band,
                                                        world_.frame.handover_mode);
                };
                if (std::abs(margin) < 1e-3f || near(d - 1e-3f) != near(d + 1e-3f)) {
                    continue;
                }
                const bool keep = near(d) && blade.root.w < density && margin > 0;
                EXPECT_EQ(kept.count({item.x, b}) > 0, keep) << "tile " << item.x << " blade " << b;
                expected += keep;
            }
        }
        EXPECT_GT(expected, 300);
        EXPECT_LT(static_cast<std::uint64_t>(expected), list_.considered);
        EXPECT_EQ(cull_.counts()[CULL_KEPT], survivors.size());
    }
};

TEST_F(Cull, SurvivorsEqualBruteForceInEveryMode) {
    for (const int mode : {shared::kHandoverRank, shared::kHandoverOff, shared::kHandoverHard,
                           shared::kHandoverFade}) {
        SCOPED_TRACE(mode);
        world_.frame.handover_mode = mode;
        world_.upload();
        select();
        expect_brute_force(cull(), 1);
    }
}

class CullThin : public Cull {
protected:
    CullThin() : Cull(0.5f) {}
};

TEST_F(CullThin, DensityTakesTheHighSeeds) {
    world_.frame.density_scale = 0.7f;
    world_.upload();
    select();
    const float density = 0.7f * 128 / 255; // the mask as eight bits hold it
    const Survivors survivors = cull();
    expect_brute_force(survivors, density);
    for (const glm::uvec2& s : survivors) {
        EXPECT_LT(world_.set.blades[s.y].root.w, density);
    }
}

TEST_F(Cull, SameOrderTwice) {
    select();
    const Survivors first = cull();
    select();
    EXPECT_EQ(first, cull());
    // Inside a workgroup's segment blades keep the order of the set.
    for (std::size_t i = 1; i < first.size(); ++i) {
        EXPECT_TRUE(first[i].x != first[i - 1].x || first[i].y > first[i - 1].y);
    }
}

TEST_F(Cull, NoDensityNoBlades) {
    world_.frame.density_scale = 0;
    world_.upload();
    select();
    EXPECT_TRUE(cull().empty());
    EXPECT_EQ(cull_.counts()[CULL_KEPT], 0u);
}

TEST_F(Cull, OrientationTakesBladesEdgeOn) {
    select();
    const Survivors all = cull(), kept = cull({.orientation = true, .occlusion = false});
    std::set<std::pair<unsigned, unsigned>> left;
    for (const glm::uvec2& s : kept) {
        left.emplace(s.x, s.y);
    }
    std::size_t taken = 0;
    for (const glm::uvec2& s : all) {
        const vec3 view = glm::normalize(root(s) - world_.frame.eye);
        const float along =
            std::abs(glm::dot(view, shared::blade_width_direction(laid(s).shape.x)));
        if (std::abs(along - 0.9f) > 1e-4f) {
            EXPECT_EQ(left.count({s.x, s.y}), along > 0.9f ? 0u : 1u);
            taken += along > 0.9f;
        }
    }
    EXPECT_GT(taken, 0.05 * static_cast<double>(all.size()));
}

// ---- occlusion

gl::Texture depth_of(int width, int height, const std::vector<float>& values) {
    gl::Texture depth(GL_DEPTH_COMPONENT32F, {width, height});
    depth.upload(0, GL_DEPTH_COMPONENT, GL_FLOAT, values.data());
    return depth;
}

TEST_F(Blades, PyramidHoldsTheFarthestOfItsPixels) {
    constexpr int kWidth = 37, kHeight = 21;
    std::vector<float> values(kWidth * kHeight);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<float>((i * 2654435761u >> 8) % 4096) / 4096.0f;
    }
    blades::DepthPyramid pyramid;
    pyramid.build(depth_of(kWidth, kHeight, values), 1);
    const gl::TextureShape& shape = pyramid.texture().shape();
    ASSERT_EQ(shape.width, 32);
    ASSERT_EQ(shape.height, 16);
    for (int level = 0; level < shape.mips; ++level) {
        const int width = std::max(shape.width >> level, 1),
                  height = std::max(shape.height >> level, 1), side = 2 << level;
        std::vector<float> found(static_cast<std::size_t>(width * height));
        glGetTextureImage(pyramid.texture().id(), level, GL_RED, GL_FLOAT,
                          static_cast<GLsizei>(found.size() * sizeof(float)), found.data());
        for (int y = 0; y * side < kHeight; ++y) {
            for (int x = 0; x * side < kWidth; ++x) {
                float least = 1;
                for (int py = y * side; py < std::min((y + 1) * side, kHeight); ++py) {
                    for (int px = x * side; px < std::min((x + 1) * side, kWidth); ++px) {
                        least = std::min(least, values[static_cast<std::size_t>(py * kWidth + px)]);
                    }
                }
                ASSERT_EQ(found[static_cast<std::size_t>(y * width + x)], least)
                    << level << ": " << x << ", " << y;
            }
        }
    }
}

TEST_F(Cull, WhatAWallHidesIsTakenAndNothingElse) {
    const glm::ivec2 size(320, 180);
    world_.frame.picture_px.x = size.x;
    world_.frame.picture_px.y = size.y;
    world_.upload();
    select();
    const Survivors all = cull();
    // A wall at 4 m over the left half of the picture, nothing over the right.
    constexpr float kWall_m = 4;
    std::vector<float> depth(static_cast<std::size_t>(size.x * size.y), 0.0f);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        depth[i] = static_cast<int>(i) % size.x < size.x / 2 ? shared::kNear_m / kWall_m : 0;
    }
    blades::DepthPyramid pyramid;
    pyramid.build(depth_of(size.x, size.y, depth), 1);
    std::set<std::pair<unsigned, unsigned>> left;
    for (const glm::uvec2& s : cull({})) {
        left.emplace(s.x, s.y);
    }
    int hidden = 0, taken = 0;
    for (const glm::uvec2& s : all) {
        const vec4 clip = world_.frame.clip_from_world * vec4(root(s), 1);
        const float reach = world_.set.blades[s.y].shape.y;
        const bool behind = clip.x < 0 && clip.w > kWall_m;
        if (left.count({s.x, s.y}) == 0) {
            ++taken;
            EXPECT_TRUE(behind && clip.w > kWall_m + 0.9f * reach);
        }
        // Well behind it, and away from the rims of both.
        hidden += behind && clip.w > kWall_m + 2 * reach && clip.x < -0.3f * clip.w &&
                  clip.x > -0.7f * clip.w && std::abs(clip.y) < 0.7f * clip.w;
    }
    EXPECT_GT(hidden, 20);
    EXPECT_GE(taken, hidden);
    EXPECT_EQ(cull_.counts()[CULL_OCCLUSION], static_cast<unsigned>(taken));
}

// ---- tessellation

struct Vertex {
    vec3 world, tangent;
    vec2 along;
    vec4 own;
};
static_assert(sizeof(Vertex) == 48);

/// The blade program without its fragments, its tessellated vertices captured.
class CapturedBlades : public Blades {
protected:
    CapturedBlades()
        : captured_(kMaxVertices * sizeof(Vertex)), picture_(GL_RGBA8, {8, 8}),
          framebuffer_({&picture_}, nullptr) {
        program_ = glCreateProgram();
        for (const auto& [path, stage] : {std::pair{"blades/blade.vert", GL_VERTEX_SHADER},
                                          {"blades/blade.tesc", GL_TESS_CONTROL_SHADER},
                                          {"blades/blade.tese", GL_TESS_EVALUATION_SHADER}}) {
            const std::string text = gl::expand_shader(path, {}).text;
            const char* source = text.c_str();
            const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
            glShaderSource(shader, 1, &source, nullptr);
            glCompileShader(shader);
            glAttachShader(program_, shader);
            glDeleteShader(shader);
        }
        const char* names[] = {"world", "tangent", "along", "own"};
        glTransformFeedbackVaryings(program_, 4, names, GL_INTERLEAVED_ATTRIBS);
        glLinkProgram(program_);
        GLint linked = 0;
        glGetProgramiv(program_, GL_LINK_STATUS, &linked);
        EXPECT_TRUE(linked);
        glCreateVertexArrays(1, &vertex_array_);
        glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &query_);
    }
    ~CapturedBlades() override {
        glDeleteProgram(program_);
        glDeleteVertexArrays(1, &vertex_array_);
        glDeleteQueries(1, &query_);
    }
    /// Triangles of the survivor at `place` of the buffer.
    std::vector<Vertex> tessellate(int place) {
        glUseProgram(program_);
        glBindVertexArray(vertex_array_);
        cull_.survivors().bind_storage(BIND_SURVIVORS);
        glPatchParameteri(GL_PATCH_VERTICES, 1);
        framebuffer_.bind(8, 8); // nothing is drawn, but a draw wants one
        glEnable(GL_RASTERIZER_DISCARD);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured_.id());
        glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query_);
        glBeginTransformFeedback(GL_TRIANGLES);
        glDrawArrays(GL_PATCHES, place, 1);
        glEndTransformFeedback();
        glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
        glDisable(GL_RASTERIZER_DISCARD);
        GLuint triangles = 0;
        glGetQueryObjectuiv(query_, GL_QUERY_RESULT, &triangles);
        return captured_.read_all<Vertex>(3 * static_cast<std::size_t>(triangles));
    }

    static constexpr std::size_t kMaxVertices = 4096;
    GLuint program_ = 0, vertex_array_ = 0, query_ = 0;
    gl::Buffer captured_;
    gl::Texture picture_;
    gl::Framebuffer framebuffer_;
};

/// J8 in C++: place u across and v along a posed blade. Width correction as in blade.tese.
vec3 blade_surface(const shared::FrameConstants& frame, const BladeRecord& blade, vec3 root,
                   vec3 v1, vec3 v2, vec2 uv) {
    const vec3 centre = root + shared::blade_curve(v1, v2, uv.y);
    const vec3 across = shared::blade_width_direction(blade.shape.x);
    const vec3 normal = glm::normalize(glm::cross(shared::blade_tangent(v1, v2, uv.y), across));
    const float pixels =
        2 * blade.v1.w * frame.focal_px / std::max(glm::distance(centre, frame.eye), 0.05f);
    const float thin =
        1 - glm::clamp((pixels - frame.width_least_px) / frame.width_span_px, 0.0f, 1.0f);
    const float t =
        glm::mix(shared::blade_outline(uv.x, uv.y, frame.looks[0].outline), uv.x, thin * thin);
    return centre + across * (blade.v1.w * (2 * t - 1)) +
           normal * (blade.v1.w * (0.5f - std::abs(uv.x - 0.5f)) * (1 - uv.y));
}

TEST_F(CapturedBlades, StandWhereTheCurveAndOutlineSay) {
    select();
    const Survivors survivors = cull();
    int folded = 0, posed = 0, checked = 0, fluttering = 0;
    for (std::size_t n = 0; n < survivors.size(); n += 7) {
        const glm::uvec2 which = survivors[n];
        const BladeRecord blade = laid(which);
        const vec3 at = root(which);
        const float distance = glm::distance(at, world_.frame.lod_eye);
        const float shell = shared::pose_share(blade.root.z, distance, world_.frame.pose_band);
        vec3 v1(blade.v1), v2(blade.v2);
        const vec2 wind = world_.wind_at(vec2(at.x, at.z));
        shared::pose_blade(
            v1, v2, vec4(blade.shape.y, world_.set.canopy_m, world_.frame.wind.response, shell),
            wind);
        const float response = world_.frame.wind.response;
        const vec3 flutter = shared::flutter_at(
            world_.frame.flutter_time, vec4(blade.shape.y, blade.v2.w, blade.root.z, blade.root.w),
            (1 - shell) * shared::flutter_amplitude(glm::length(wind), response));
        fluttering += glm::length(flutter) > 1e-3f;
        shared::flutter_blade(v1, v2, blade.shape.y, vec2(flutter), wind);
        BladeRecord turned = blade;
        turned.shape.x += flutter.z;
        const auto vertices = tessellate(places_[n]);
        ASSERT_GE(vertices.size(), 12u);
        std::set<float> rows;
        bool middle = false;
        for (const Vertex& vertex : vertices) {
            float best = 1e9f;
            for (const float u : {0.0f, 0.5f, 1.0f}) {
                const float off =
                    glm::distance(vertex.world, blade_surface(world_.frame, turned, at, v1, v2,
                                                              {u, vertex.along.x}));
                middle |= u == 0.5f && off < best && off < 1e-4f;
                best = std::min(best, off);
            }
            ASSERT_LT(best, 1e-4f) << "blade " << which.y << " at v " << vertex.along.x;
            const float rest =
                shared::blade_curve(vec3(blade.v1), vec3(blade.v2), vertex.along.x).y /
                world_.set.canopy_m;
            ASSERT_NEAR(vertex.along.y, rest, 1e-5f);
            ASSERT_NEAR(vertex.own.z, distance, 1e-4f);
            ASSERT_EQ(vec2(vertex.own), vec2(blade.root.z, blade.root.w));
            rows.insert(vertex.along.x);
        }
        ASSERT_EQ(*rows.begin(), 0.0f);
        ASSERT_EQ(*rows.rbegin(), 1.0f);
        ASSERT_GE(rows.size(), 3u);
        folded += middle;
        posed += shell > 0.5f;
        ++checked;
    }
    EXPECT_GT(checked, 50);
    EXPECT_GT(folded, 10);
    EXPECT_GT(fluttering, 10);
    EXPECT_GT(posed, 10); // both ends of the band were seen
    EXPECT_LT(posed, checked - 10);
}

} // namespace
} // namespace sward::tests
