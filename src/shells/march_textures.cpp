// SPDX-License-Identifier: Apache-2.0
#include "shells/march_textures.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "shared/bindings.h"

namespace sward::shells {

namespace {

gl::Texture upload(const grass::TextureArray& array, std::uint32_t format, std::uint32_t type) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
    if (array.layers > limit) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("grass set: found {} images in one array, this GPU takes {}",
                                      array.layers, limit));
    }
    const int mips = static_cast<int>(array.mips.size());
    gl::Texture texture(format, {array.width, array.height, array.layers, mips});
    for (int mip = 0; mip < mips; ++mip) {
        texture.upload(mip, GL_RGBA, type, array.mips[static_cast<std::size_t>(mip)].data());
    }
    texture.set_filter(mips > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR, GL_LINEAR);
    return texture;
}

} // namespace

MarchTextures::MarchTextures(const grass::FarMedium& march) {
    if (march.columns.density.mips.empty()) {
        return;
    }
    medium_ = gl::Buffer(sizeof(shared::MarchMedium));
    medium_.upload(&march.medium, sizeof(march.medium));
    for (std::size_t kind = 0; kind < images_.size(); ++kind) {
        const bool columns = kind == shared::kMarchColumns;
        const grass::MarchArrays& arrays = columns ? march.columns : march.slabs[kind];
        images_[kind] = {upload(arrays.density, GL_RGBA16F, GL_HALF_FLOAT),
                         upload(arrays.fibres, GL_RGBA8, GL_UNSIGNED_BYTE)};
        for (gl::Texture* texture : {&images_[kind].density, &images_[kind].fibres}) {
            texture->set_wrap(GL_REPEAT, columns ? GL_REPEAT : GL_CLAMP_TO_EDGE);
        }
    }
    correction_ =
        gl::Texture(GL_RGBA32F, {shared::kMarchElevations, shared::kMarchMips, grass::kMarchKinds});
    correction_.upload(0, GL_RGBA, GL_FLOAT, march.correction.data());
    correction_.set_filter(GL_LINEAR, GL_LINEAR);
    correction_.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
}

void MarchTextures::bind() const {
    medium_.bind_uniform(BIND_MARCH);
    correction_.bind(TEX_MARCH_CORRECTION);
}

void MarchTextures::bind_kind(int kind) const {
    const Images& images = images_[static_cast<std::size_t>(kind)];
    images.density.bind(TEX_MARCH_DENSITY);
    images.fibres.bind(TEX_MARCH_FIBRES);
}

} // namespace sward::shells
