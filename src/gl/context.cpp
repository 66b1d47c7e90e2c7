// SPDX-License-Identifier: Apache-2.0
#include "gl/context.h"

#include <cstdlib>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/room.h"

namespace sward::gl {

using base::Error;
using base::ExitCode;

namespace {

constexpr std::size_t kDriverRoom =
    std::size_t{512} << 20; ///< a driver with its compiler may take so much address space

} // namespace

struct HeadlessContext::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string platform;

    /// True when `candidate` gave a current 4.5 core context.
    bool try_display(EGLDisplay candidate, bool debug) {
        ::setenv("EGL_LOG_LEVEL", "fatal", 0); // what its loader could not do is told once, by us
        if (candidate == EGL_NO_DISPLAY || !eglInitialize(candidate, nullptr, nullptr)) {
            return false;
        }
        const EGLint config_wants[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                       EGL_OPENGL_BIT, EGL_NONE};
        const EGLint context_wants[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        5,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_CONTEXT_OPENGL_DEBUG,
                                        debug ? EGL_TRUE : EGL_FALSE,
                                        EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (eglBindAPI(EGL_OPENGL_API) &&
            eglChooseConfig(candidate, config_wants, &config, 1, &count) && count > 0) {
            context = eglCreateContext(candidate, config, EGL_NO_CONTEXT, context_wants);
            if (context != EGL_NO_CONTEXT &&
                eglMakeCurrent(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
                display = candidate;
                return true;
            }
            if (context != EGL_NO_CONTEXT) {
                eglDestroyContext(candidate, context);
                context = EGL_NO_CONTEXT;
            }
        }
        eglTerminate(candidate);
        return false;
    }
};

HeadlessContext::HeadlessContext(bool debug) : impl_(std::make_unique<Impl>()) {
    // Devices first: on a machine with a GPU the surfaceless platform would be Mesa's software
    // renderer.
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
        eglQueryDevicesEXT(16, devices, &count)) {
        for (int i = 0; i < count; ++i) {
            const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
            const bool software =
                extensions &&
                std::string(extensions).find("EGL_MESA_device_software") != std::string::npos;
            if (!software && impl_->try_display(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT,
                                                                         devices[i], nullptr),
                                                debug)) {
                impl_->platform = fmt::format("device {}", i);
                return;
            }
        }
    }
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
        impl_->try_display(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
            debug)) {
        impl_->platform = "surfaceless";
        return;
    }
    base::refuse_if_starved(kDriverRoom);
    throw Error(
        ExitCode::kNoGpu,
        fmt::format(
            "GPU: no OpenGL 4.5 core context through EGL ({} devices and the surfaceless "
            "platform tried); is a driver installed (Debian: libegl-mesa0 libgl1-mesa-dri)?",
            count));
}

HeadlessContext::~HeadlessContext() {
    eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(impl_->display, impl_->context);
    eglTerminate(impl_->display);
}

const std::string& HeadlessContext::platform() const {
    return impl_->platform;
}

ContextInfo context_info() {
    const auto text = [](GLenum name) {
        return std::string(reinterpret_cast<const char*>(glGetString(name)));
    };
    ContextInfo info{text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION),
                     text(GL_SHADING_LANGUAGE_VERSION)};
    glGetIntegerv(GL_MAX_SAMPLES, &info.max_samples);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info.max_texture_size);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &info.max_array_layers);
    GLint64 storage = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storage);
    info.max_storage_bytes = storage;
    return info;
}

void require_gl45() {
    if (epoxy_gl_version() < 45) {
        throw Error(ExitCode::kNoGpu,
                    fmt::format("GPU: found OpenGL {}.{}, expected 4.5 or later",
                                epoxy_gl_version() / 10, epoxy_gl_version() % 10));
    }
}

void watch_debug_messages(DebugMessages* sink) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(
        [](GLenum, GLenum, GLuint, GLenum severity, GLsizei, const GLchar* message,
           const void* user) {
            if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) {
                return;
            }
            auto* out = static_cast<DebugMessages*>(const_cast<void*>(user));
            if (out->count++ == 0) {
                out->first = message;
            }
        },
        sink);
}

} // namespace sward::gl
