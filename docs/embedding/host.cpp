// SPDX-License-Identifier: Apache-2.0
// A program with its own context, loop, picture and box, around which Sward draws land: host SCENE SET OUT.ppm [FRAMES]
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <sward/field.h>
#include <sward/view.h>

namespace {
constexpr int kWidth = 320, kHeight = 200;
constexpr char kVertex[] = R"(#version 450 core // a box of 1 m
uniform mat4 clip_from_box;
void main() {
    const int corners[36] = int[](0,1,3,0,3,2, 4,6,7,4,7,5, 0,4,5,0,5,1, 2,3,7,2,7,6, 0,2,6,0,6,4, 1,5,7,1,7,3);
    int c = corners[gl_VertexID];
    gl_Position = clip_from_box * vec4(c & 1, (c >> 1) & 1, (c >> 2) & 1, 1.0);
})";
constexpr char kFragment[] = R"(#version 450 core
out vec4 radiance; void main() { radiance = vec4(1.5, 0.1, 0.05, 1.0); })";

void make_context() {
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint wants[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglInitialize(display, nullptr, nullptr);
    eglChooseConfig(display, wants, &config, eglBindAPI(EGL_OPENGL_API), &count);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, eglCreateContext(display, config, EGL_NO_CONTEXT, version));
}

GLuint make_program() {
    const GLuint program = glCreateProgram();
    for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, kVertex}, std::pair{GL_FRAGMENT_SHADER, kFragment}}) {
        const GLuint shader = glCreateShader(kind);
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    return program;
}

GLuint make_texture(GLenum format) {
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, kWidth, kHeight);
    return texture;
}

int run(char** arguments, int frames) {
    make_context();
    GLuint framebuffer = 0, vertices = 0;
    glCreateVertexArrays(1, &vertices);
    glCreateFramebuffers(1, &framebuffer);
    const GLuint colour = make_texture(GL_RGBA16F), depth = make_texture(GL_DEPTH_COMPONENT32F);
    const GLuint program = make_program();
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, colour, 0);
    glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, depth, 0);
    sward::Target target{.width = kWidth, .height = kHeight};
    target.colour = target.scene_colour = colour; // Sward takes what stands in it, and gives it back among the grass
    target.depth = target.scene_depth = depth;
    sward::FieldSource source;
    source.scene = arguments[1];
    source.grass_set = arguments[2];
    sward::Field field(source);
    while (field.prepare() > 0) { // a step a frame would do
    }
    sward::View view(field);
    for (int frame = 0; frame < frames; ++frame) {
        sward::CameraPose pose; // banked by 25 degrees
        pose.position = {0, std::ceil(field.ground_height(0, 0) + 1.4), 0};
        pose.pitch_deg = -10;
        pose.roll_deg = 25;
        const sward::Camera camera = sward::camera_of(pose, kWidth, kHeight);

        // The host's own drawing, in linear radiance and with the camera's depth.
        glm::dmat4 place(1);
        place[3] = glm::dvec4(-0.5, field.ground_height(0, -4) - 0.2, -4.5, 1);
        const glm::mat4 clip_from_box(camera.clip_from_view * camera.view_from_world * place);
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, kWidth, kHeight);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GREATER);
        glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, std::array<float, 4>{}.data());
        glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, std::array<float, 4>{}.data()); // reversed: 0 is far away
        glUseProgram(program);
        glBindVertexArray(vertices);
        glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(clip_from_box));
        glDrawArrays(GL_TRIANGLES, 0, 36);
        // Sward takes that picture, draws land and grass around and before the box, and gives it back.
        const glm::dvec3 eye = sward::eye_of(camera);
        field.simulate(frame / 60.0, {&eye, 1});
        view.draw(camera, target);
    }
    const std::vector<std::uint8_t> rgb = view.read_picture();
    std::ofstream(arguments[3]) << "P6 " << kWidth << ' ' << kHeight << " 255\n" << std::string(rgb.begin(), rgb.end());
    return 0;
}

} // namespace
int main(int count, char** arguments) {
    try {
        return count < 4 ? 2 : run(arguments, count > 4 ? std::atoi(arguments[4]) : 1);
    } catch (const sward::Error& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
