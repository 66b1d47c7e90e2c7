// SPDX-License-Identifier: Apache-2.0
// A host's OpenGL state: hostile before a call, the same after it, and no part of the picture.
#include <chrono>
#include <functional>
#include <map>
#include <numeric>
#include <string>

#include "gl/face_fixture.h"
#include "gl/framebuffer.h"
#include "gl/state_guard.h"
#include "gl/texture.h"

namespace sward::tests {
namespace {

using Dump = std::map<std::string, std::vector<double>>;

/// All that a fresh context can be asked for and that drawing may touch, guarded or not.
class Dumper {
public:
    Dump take() {
        dump_.clear();
        for (const GLenum cap : {GL_BLEND,
                                 GL_CULL_FACE,
                                 GL_DEPTH_TEST,
                                 GL_STENCIL_TEST,
                                 GL_SCISSOR_TEST,
                                 GL_DEPTH_CLAMP,
                                 GL_DITHER,
                                 GL_MULTISAMPLE,
                                 GL_POLYGON_OFFSET_FILL,
                                 GL_POLYGON_OFFSET_LINE,
                                 GL_POLYGON_OFFSET_POINT,
                                 GL_POLYGON_SMOOTH,
                                 GL_LINE_SMOOTH,
                                 GL_COLOR_LOGIC_OP,
                                 GL_RASTERIZER_DISCARD,
                                 GL_PRIMITIVE_RESTART,
                                 GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                 GL_SAMPLE_ALPHA_TO_COVERAGE,
                                 GL_SAMPLE_ALPHA_TO_ONE,
                                 GL_SAMPLE_COVERAGE,
                                 GL_SAMPLE_MASK,
                                 GL_SAMPLE_SHADING,
                                 GL_FRAMEBUFFER_SRGB,
                                 GL_PROGRAM_POINT_SIZE,
                                 GL_TEXTURE_CUBE_MAP_SEAMLESS,
                                 GL_CLIP_DISTANCE0,
                                 GL_CLIP_DISTANCE3,
                                 GL_CLIP_DISTANCE7}) {
            put("enabled", cap, {static_cast<double>(glIsEnabled(cap))});
        }
        for (const GLenum name : {GL_CURRENT_PROGRAM,
                                  GL_VERTEX_ARRAY_BINDING,
                                  GL_DRAW_FRAMEBUFFER_BINDING,
                                  GL_READ_FRAMEBUFFER_BINDING,
                                  GL_RENDERBUFFER_BINDING,
                                  GL_ACTIVE_TEXTURE,
                                  GL_ARRAY_BUFFER_BINDING,
                                  GL_COPY_READ_BUFFER_BINDING,
                                  GL_COPY_WRITE_BUFFER_BINDING,
                                  GL_DRAW_INDIRECT_BUFFER_BINDING,
                                  GL_DISPATCH_INDIRECT_BUFFER_BINDING,
                                  GL_PIXEL_PACK_BUFFER_BINDING,
                                  GL_PIXEL_UNPACK_BUFFER_BINDING,
                                  GL_QUERY_BUFFER_BINDING,
                                  GL_UNIFORM_BUFFER_BINDING,
                                  GL_SHADER_STORAGE_BUFFER_BINDING,
                                  GL_PROGRAM_PIPELINE_BINDING,
                                  GL_CULL_FACE_MODE,
                                  GL_FRONT_FACE,
                                  GL_DEPTH_FUNC,
                                  GL_DEPTH_WRITEMASK,
                                  GL_CLIP_ORIGIN,
                                  GL_CLIP_DEPTH_MODE,
                                  GL_PROVOKING_VERTEX,
                                  GL_PATCH_VERTICES,
                                  GL_LOGIC_OP_MODE,
                                  GL_PRIMITIVE_RESTART_INDEX,
                                  GL_STENCIL_FUNC,
                                  GL_STENCIL_REF,
                                  GL_STENCIL_WRITEMASK,
                                  GL_STENCIL_CLEAR_VALUE,
                                  GL_UNPACK_ALIGNMENT,
                                  GL_UNPACK_ROW_LENGTH,
                                  GL_UNPACK_SKIP_ROWS,
                                  GL_UNPACK_SKIP_PIXELS,
                                  GL_UNPACK_IMAGE_HEIGHT,
                                  GL_UNPACK_SKIP_IMAGES,
                                  GL_UNPACK_SWAP_BYTES,
                                  GL_PACK_ALIGNMENT,
                                  GL_PACK_ROW_LENGTH,
                                  GL_PACK_SKIP_ROWS,
                                  GL_PACK_SKIP_PIXELS,
                                  GL_PACK_SWAP_BYTES,
                                  GL_SAMPLE_COVERAGE_INVERT}) {
            GLint value = 0;
            glGetIntegerv(name, &value);
            put("integer", name, {static_cast<double>(value)});
        }
        for (const GLenum name :
             {GL_POLYGON_OFFSET_FACTOR, GL_POLYGON_OFFSET_UNITS, GL_LINE_WIDTH, GL_POINT_SIZE,
              GL_MIN_SAMPLE_SHADING_VALUE, GL_SAMPLE_COVERAGE_VALUE, GL_DEPTH_CLEAR_VALUE}) {
            GLfloat value = 0;
            glGetFloatv(name, &value);
            put("float", name, {static_cast<double>(value)});
        }
        GLint mode[2] = {};
        glGetIntegerv(GL_POLYGON_MODE, mode);
        put("polygon mode", 0, {static_cast<double>(mode[0])});
        GLfloat clear[4] = {};
        glGetFloatv(GL_COLOR_CLEAR_VALUE, clear);
        put("clear colour", 0, {clear[0], clear[1], clear[2], clear[3]});
        indexed();
        units();
        return dump_;
    }

private:
    void put(const std::string& kind, GLuint which, std::vector<double> values) {
        dump_[kind + " " + std::to_string(which)] = std::move(values);
    }
    void integers(const char* kind, GLuint index, std::initializer_list<GLenum> names) {
        std::vector<double> values;
        for (const GLenum name : names) {
            GLint value = 0;
            glGetIntegeri_v(name, index, &value);
            values.push_back(value);
        }
        put(kind, index, values);
    }
    void indexed() {
        for (GLuint i = 0; i < 8; ++i) {
            GLboolean mask[4] = {};
            glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask);
            put("draw buffer", i,
                {static_cast<double>(glIsEnabledi(GL_BLEND, i)), static_cast<double>(mask[0]),
                 static_cast<double>(mask[1]), static_cast<double>(mask[2]),
                 static_cast<double>(mask[3])});
            integers("blend", i,
                     {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA,
                      GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA});
            integers("image", i,
                     {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL, GL_IMAGE_BINDING_LAYERED,
                      GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT});
            integers("uniform buffer", i,
                     {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE});
            integers("storage buffer", i,
                     {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                      GL_SHADER_STORAGE_BUFFER_SIZE});
        }
        for (GLuint i = 0; i < 16; ++i) {
            GLfloat view[4] = {};
            GLdouble depth[2] = {};
            GLint box[4] = {};
            glGetFloati_v(GL_VIEWPORT, i, view);
            glGetDoublei_v(GL_DEPTH_RANGE, i, depth);
            glGetIntegeri_v(GL_SCISSOR_BOX, i, box);
            put("viewport", i,
                {view[0], view[1], view[2], view[3], depth[0], depth[1],
                 static_cast<double>(box[0]), static_cast<double>(box[1]),
                 static_cast<double>(box[2]), static_cast<double>(box[3]),
                 static_cast<double>(glIsEnabledi(GL_SCISSOR_TEST, i))});
        }
    }
    void units() {
        for (GLuint unit = 0; unit < 32; ++unit) {
            integers("unit", unit,
                     {GL_TEXTURE_BINDING_1D, GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_3D,
                      GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP,
                      GL_TEXTURE_BINDING_BUFFER, GL_TEXTURE_BINDING_2D_MULTISAMPLE,
                      GL_SAMPLER_BINDING});
        }
    }
    Dump dump_;
};

/// State that would spoil any picture, each kind of it.
class Hostile {
public:
    Hostile() {
        glCreateSamplers(1, &sampler_);
        glSamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
        glSamplerParameterf(sampler_, GL_TEXTURE_MIN_LOD, 3);
        glCreateBuffers(1, &buffer_);
        glNamedBufferStorage(buffer_, 1 << 20, nullptr, GL_DYNAMIC_STORAGE_BIT);
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &buffer_texture_);
        glTextureBuffer(buffer_texture_, GL_R32F, buffer_);
        glCreateVertexArrays(1, &vertex_array_);
    }
    ~Hostile() {
        glDeleteSamplers(1, &sampler_);
        glDeleteTextures(1, &buffer_texture_);
        glDeleteBuffers(1, &buffer_);
        glDeleteVertexArrays(1, &vertex_array_);
    }
    void set() const {
        for (const GLenum cap :
             {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST,
              GL_DEPTH_CLAMP, GL_POLYGON_OFFSET_FILL, GL_COLOR_LOGIC_OP, GL_RASTERIZER_DISCARD,
              GL_PRIMITIVE_RESTART, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE,
              GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_FRAMEBUFFER_SRGB, GL_CLIP_DISTANCE0,
              GL_CLIP_DISTANCE3}) {
            glEnable(cap);
        }
        glDisable(GL_MULTISAMPLE);
        glDisable(GL_DITHER);
        glBlendFunc(GL_DST_COLOR, GL_ONE_MINUS_SRC_ALPHA);
        glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
        glLogicOp(GL_INVERT);
        glCullFace(GL_FRONT_AND_BACK);
        glFrontFace(GL_CW);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glPolygonOffset(50, 70);
        glDepthFunc(GL_NEVER);
        glDepthMask(GL_FALSE);
        glDepthRange(0.8, 0.2);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        glStencilFunc(GL_NEVER, 3, 0xff);
        glSampleMaski(0, 0);
        glSampleCoverage(0, GL_FALSE);
        glPrimitiveRestartIndex(5);
        glScissor(3, 5, 7, 9);
        glViewport(11, 13, 17, 19);
        glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        glPatchParameteri(GL_PATCH_VERTICES, 7);
        for (const GLenum store :
             {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS,
              GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES,
              GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES}) {
            glPixelStorei(store, 1);
        }
        glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
        glPixelStorei(GL_PACK_ALIGNMENT, 2);
        for (const GLenum target :
             {GL_DRAW_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER, GL_PIXEL_PACK_BUFFER,
              GL_PIXEL_UNPACK_BUFFER, GL_QUERY_BUFFER, GL_ARRAY_BUFFER}) {
            glBindBuffer(target, buffer_);
        }
        for (GLuint i = 0; i < 8; ++i) {
            glBindBufferRange(GL_UNIFORM_BUFFER, i, buffer_, 4096 * i, 1024);
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, buffer_, 4096 * i, 512);
        }
        glBindBuffer(GL_UNIFORM_BUFFER, 0);
        for (GLuint unit = 0; unit < 32; ++unit) {
            glBindSampler(unit, sampler_);
            glBindTextureUnit(unit, flat_.id());
            glBindTextureUnit(unit, array_.id());
            glBindTextureUnit(unit, buffer_texture_);
        }
        glActiveTexture(GL_TEXTURE5);
        glBindImageTexture(0, flat_.id(), 1, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
        glBindVertexArray(vertex_array_);
        glUseProgram(program_.id());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    }

private:
    gl::Texture flat_{GL_RGBA8, {8, 8, 0, 2}}, array_{GL_RGBA8, {4, 4, 2}};
    gl::Framebuffer framebuffer_{{&flat_}, nullptr};
    gl::Program program_{"sky", {"render/screen.vert", "render/sky.frag"}};
    GLuint sampler_ = 0, buffer_ = 0, buffer_texture_ = 0, vertex_array_ = 0;
};

class State : public Face {
protected:
    static void expect_same(const Dump& before, const Dump& after, const char* what) {
        for (const auto& [name, values] : before) {
            EXPECT_EQ(after.at(name), values) << what << ": " << name;
        }
    }
};

TEST_F(State, EveryCallLeavesAHostilesStateAndDrawsAsEver) {
    Dumper dumper;
    Field plain_field = render::Access::field_of(face_world());
    View plain(plain_field);
    const Camera camera = camera_of(pose_over(plain_field), kWidth, kHeight);
    simulate(plain_field, 0.5, camera);
    const Bytes wanted = picture(plain, camera);

    const Hostile hostile;
    Field field = render::Access::field_of(face_world());
    View view(field);
    hostile.set();
    const Dump before = dumper.take();
    const Ball ball{{21, field.ground_height(21, 29), 29}, 0.4};
    field.set_colliders({&ball, 1}, 0);
    field.set_colliders({}, 0);
    expect_same(before, dumper.take(), "set_colliders");
    simulate(field, 0.5, camera);
    expect_same(before, dumper.take(), "simulate");
    view.draw(camera, {kWidth, kHeight});
    expect_same(before, dumper.take(), "draw");
    const Bytes drawn = view.read_picture();
    expect_same(before, dumper.take(), "read_picture");
    {
        View another(field);
        expect_same(before, dumper.take(), "a view made");
        EXPECT_EQ(picture(another, camera), wanted);
    }
    expect_same(before, dumper.take(), "a view gone");
    EXPECT_EQ(drawn, wanted);
    field.set_wind({7, 100, 0.3});
    field.set_sun({10, 40});
    simulate(field, 0.6, camera);
    expect_same(before, dumper.take(), "another wind");
}

TEST_F(State, TheGuardsCost) {
    constexpr int kTimes = 2000;
    { const gl::StateGuard first; }
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kTimes; ++i) {
        const gl::StateGuard guard;
    }
    const std::chrono::duration<double, std::micro> passed =
        std::chrono::steady_clock::now() - start;
    const double each = passed.count() / kTimes;
    RecordProperty("microseconds", static_cast<int>(each));
    std::printf("state guard: %.1f us each\n", each);
    EXPECT_GT(each, 0);
}

// ---- a host's own picture and depth

struct HostPicture {
    gl::Texture colour{GL_RGBA16F, {kWidth, kHeight}},
        depth{GL_DEPTH_COMPONENT32F, {kWidth, kHeight}};
    [[nodiscard]] std::vector<float> depths() const {
        std::vector<float> out(static_cast<std::size_t>(kWidth) * kHeight);
        glGetTextureImage(depth.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                          static_cast<GLsizei>(4 * out.size()), out.data());
        return out;
    }
};

TEST_F(State, AHostsWallStandsInTheGrassWhateverItsDepth) {
    Field field = render::Access::field_of(face_world());
    View view(field);
    Camera camera = camera_of(pose_over(field), kWidth, kHeight);
    simulate(field, 1, camera);
    const Bytes bare = picture(view, camera);
    constexpr double kWall_m = 4, kFar_m = 5000;
    Bytes first;
    for (const bool reversed : {true, false}) {
        if (!reversed) { // OpenGL's usual one, with a far plane
            camera.clip_depth = ClipDepth::kMinusOneToOne;
            camera.clip_from_view[2][2] = -(kFar_m + kNear_m) / (kFar_m - kNear_m);
            camera.clip_from_view[3][2] = -2 * kFar_m * kNear_m / (kFar_m - kNear_m);
        }
        const auto host_depth = [&](double distance_m) {
            return static_cast<float>(reversed
                                          ? kNear_m / distance_m
                                          : 0.5 + 0.5 *
                                                      (camera.clip_from_view[2][2] * -distance_m +
                                                       camera.clip_from_view[3][2]) /
                                                      distance_m);
        };
        HostPicture host;
        std::vector<float> depth(static_cast<std::size_t>(kWidth) * kHeight,
                                 reversed ? 0.0f : 1.0f),
            colour(4 * depth.size(), 0);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = kWidth / 2; x < kWidth; ++x) {
                const auto at = static_cast<std::size_t>(y * kWidth + x);
                depth[at] = host_depth(kWall_m);
                colour[4 * at] = 5; // bright red
            }
        }
        host.depth.upload(0, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        host.colour.upload(0, GL_RGBA, GL_FLOAT, colour.data());
        Target target{kWidth, kHeight};
        target.scene_colour = target.colour = host.colour.id();
        target.scene_depth = target.depth = host.depth.id();
        view.draw(camera, target);
        const Bytes drawn = view.read_picture();
        const std::vector<float> depths = host.depths(), radiance = host.colour.read_floats(4);
        int red = 0, grass = 0, other = 0, nearer = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const auto pixel = static_cast<std::size_t>(3 * ((kHeight - 1 - y) * kWidth + x)),
                           at = static_cast<std::size_t>(y * kWidth + x);
                const bool is_red = drawn[pixel] > 200 && drawn[pixel + 1] < 60;
                red += is_red ? 1 : 0;
                grass += x >= kWidth / 2 && !is_red ? 1 : 0;
                nearer += x >= kWidth / 2 && depths[at] != depth[at] ? 1 : 0;
                other +=
                    x < kWidth / 2 && !std::equal(&drawn[pixel], &drawn[pixel] + 3, &bare[pixel])
                        ? 1
                        : 0;
                if (is_red && x > kWidth / 2) {
                    EXPECT_GT(radiance[4 * at], 1.5f);
                }
            }
        }
        EXPECT_GT(red, kWidth * kHeight / 8) << "the wall hides what is behind it";
        EXPECT_GT(grass, kWidth * kHeight / 16) << "grass before it hides the wall";
        EXPECT_GT(nearer, kWidth * kHeight / 32);
        EXPECT_EQ(other, 0) << "where the host has nothing, nothing changes";
        if (reversed) {
            first = drawn;
        } else {
            EXPECT_LT(std::inner_product(drawn.begin(), drawn.end(), first.begin(), 0,
                                         std::plus<>(),
                                         [](int a, int b) { return a != b ? 1 : 0; }),
                      kWidth * kHeight / 20);
        }
    }
}

TEST_F(State, TexturesOfAnotherShapeAreRefused) {
    Field field = render::Access::field_of(face_world());
    View view(field);
    const Camera camera = camera_of(pose_over(field), kWidth, kHeight);
    simulate(field, 1, camera);
    const gl::Texture small(GL_RGBA16F, {8, 8}), layered(GL_RGBA16F, {kWidth, kHeight, 2});
    for (const std::uint32_t texture : {small.id(), layered.id(), 4242u}) {
        Target target{kWidth, kHeight};
        target.colour = texture;
        EXPECT_THROW(view.draw(camera, target), Error);
        forgive_messages();
    }
    EXPECT_GT(picture(view, camera).size(), 0u); // and the view lives on
}

} // namespace
} // namespace sward::tests
