// SPDX-License-Identifier: Apache-2.0
#include "gl/framebuffer.h"

#include <utility>

#include <epoxy/gl.h>

#include "base/error.h"

namespace sward::gl {

Framebuffer::Framebuffer(const std::vector<const Texture*>& colour, const Texture* depth) {
    glCreateFramebuffers(1, &id_);
    std::vector<GLenum> buffers;
    for (std::size_t i = 0; i < colour.size(); ++i) {
        buffers.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i));
        glNamedFramebufferTexture(id_, buffers.back(), colour[i]->id(), 0);
    }
    if (depth) {
        glNamedFramebufferTexture(id_, GL_DEPTH_ATTACHMENT, depth->id(), 0);
    }
    glNamedFramebufferDrawBuffers(id_, static_cast<GLsizei>(buffers.size()), buffers.data());
    if (glCheckNamedFramebufferStatus(id_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        glDeleteFramebuffers(1, &id_);
        throw base::Error(base::ExitCode::kNoGpu, "GPU: the driver refuses a framebuffer");
    }
}

Framebuffer::~Framebuffer() {
    if (id_) {
        glDeleteFramebuffers(1, &id_);
    }
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

void Framebuffer::bind(int width, int height) const {
    glBindFramebuffer(GL_FRAMEBUFFER, id_);
    glViewportIndexedf(0, 0, 0, static_cast<float>(width),
                       static_cast<float>(height)); // the others are a host's
}

} // namespace sward::gl
