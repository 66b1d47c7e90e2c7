// SPDX-License-Identifier: Apache-2.0
#include "gl/texture.h"

#include <algorithm>
#include <utility>

#include <epoxy/gl.h>

#include "base/error.h"
#include "gl/memory.h"

namespace sward::gl {

namespace {

int texel_bytes(std::uint32_t format) {
    switch (format) {
    case GL_R8:
    case GL_COMPRESSED_RG_RGTC2:
        return 1; // of blocks: 16 bytes for 4 x 4 texels
    case GL_RG8:
    case GL_R16F:
        return 2;
    case GL_RGBA16F:
        return 8;
    case GL_RGBA32F:
        return 16;
    default:
        return 4;
    }
}

std::uint32_t target_of(const TextureShape& shape) {
    return shape.samples > 0  ? GL_TEXTURE_2D_MULTISAMPLE
           : shape.layers > 0 ? GL_TEXTURE_2D_ARRAY
                              : GL_TEXTURE_2D;
}

} // namespace

Texture::Texture(std::uint32_t internal_format, const TextureShape& shape) : shape_(shape) {
    while (glGetError() != GL_NO_ERROR) {
    }
    glCreateTextures(target_of(shape), 1, &id_);
    if (shape.samples > 0) {
        glTextureStorage2DMultisample(id_, shape.samples, internal_format, shape.width,
                                      shape.height, GL_TRUE);
    } else if (shape.layers > 0) {
        glTextureStorage3D(id_, shape.mips, internal_format, shape.width, shape.height,
                           shape.layers);
    } else {
        glTextureStorage2D(id_, shape.mips, internal_format, shape.width, shape.height);
    }
    if (glGetError() != GL_NO_ERROR) {
        glDeleteTextures(1, &id_);
        throw base::Error(base::ExitCode::kNoGpu, "GPU: no memory for a texture of " +
                                                      std::to_string(shape.width) + " x " +
                                                      std::to_string(shape.height) + " x " +
                                                      std::to_string(std::max(shape.layers, 1)));
    }
    for (int m = 0; m < shape.mips; ++m) {
        bytes_ += std::int64_t{std::max(1, shape.width >> m)} * std::max(1, shape.height >> m) *
                  std::max(1, shape.layers) * std::max(1, shape.samples) *
                  texel_bytes(internal_format);
    }
    count_gpu_bytes(bytes_);
}

Texture::~Texture() {
    if (id_) {
        glDeleteTextures(1, &id_);
        count_gpu_bytes(-bytes_);
    }
}

Texture::Texture(Texture&& other) noexcept
    : id_(std::exchange(other.id_, 0)), shape_(other.shape_),
      bytes_(std::exchange(other.bytes_, 0)) {}

Texture& Texture::operator=(Texture&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(shape_, other.shape_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void Texture::upload(int mip, std::uint32_t format, std::uint32_t type, const void* data) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const int w = std::max(1, shape_.width >> mip);
    const int h = std::max(1, shape_.height >> mip);
    if (shape_.layers > 0) {
        glTextureSubImage3D(id_, mip, 0, 0, 0, w, h, shape_.layers, format, type, data);
    } else {
        glTextureSubImage2D(id_, mip, 0, 0, w, h, format, type, data);
    }
}

void Texture::upload_rows(int first, int rows, std::uint32_t format, std::uint32_t type,
                          const void* data) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id_, 0, 0, first, shape_.width, rows, format, type, data);
}

void Texture::upload_blocks(int mip, std::uint32_t internal_format, const void* data,
                            std::size_t bytes) {
    const int w = std::max(1, shape_.width >> mip);
    const int h = std::max(1, shape_.height >> mip);
    glCompressedTextureSubImage3D(id_, mip, 0, 0, 0, w, h, shape_.layers, internal_format,
                                  static_cast<GLsizei>(bytes), data);
}

void Texture::set_filter(std::uint32_t minify, std::uint32_t magnify) {
    glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
    glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture::set_wrap(std::uint32_t s, std::uint32_t t) {
    glTextureParameteri(id_, GL_TEXTURE_WRAP_S, static_cast<GLint>(s));
    glTextureParameteri(id_, GL_TEXTURE_WRAP_T, static_cast<GLint>(t));
}

void Texture::bind(std::uint32_t unit) const {
    glBindTextureUnit(unit, id_);
}

std::vector<float> Texture::read_floats(int components, int layer) const {
    static constexpr GLenum kFormats[] = {0, GL_RED, GL_RG, GL_RGB, GL_RGBA};
    std::vector<float> texels(static_cast<std::size_t>(shape_.width) * shape_.height * components);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(id_, 0, 0, 0, layer, shape_.width, shape_.height, 1, kFormats[components],
                         GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)),
                         texels.data());
    return texels;
}

} // namespace sward::gl
