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
        throw base::Error(base::ExitCode::kOverLimit, fmt::format("grass set: found {} images in one array, this GPU takes {}", array.layers, limit));
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
    if (march.columns.mips.empty()) {
        return;
    }
    medium_ = gl::Buffer(sizeof(shared::MarchMedium));
    medium_.upload(&march.medium, sizeof(march.medium));
    columns_ = upload(march.columns, GL_RGBA16F, GL_HALF_FLOAT);
    columns_.set_wrap(GL_REPEAT, GL_REPEAT);
    for (std::size_t k = 0; k < slabs_.size(); ++k) {
        slabs_[k] = upload(march.slabs[k], GL_RGBA16F, GL_HALF_FLOAT);
        slabs_[k].set_wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
    }
    correction_ = gl::Texture(GL_RGBA32F, {shared::kMarchElevations, shared::kMarchMips, static_cast<int>(grass::kMarchDensities.size())});
    correction_.upload(0, GL_RGBA, GL_FLOAT, march.correction.data());
    correction_.set_filter(GL_LINEAR, GL_LINEAR);
    correction_.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
}

void MarchTextures::bind() const {
    medium_.bind_uniform(BIND_MARCH);
    columns_.bind(TEX_MARCH_COLUMNS);
    for (std::size_t k = 0; k < slabs_.size(); ++k) {
        slabs_[k].bind(TEX_MARCH_SLABS + static_cast<std::uint32_t>(k));
    }
    correction_.bind(TEX_MARCH_CORRECTION);
}

} // namespace sward::shells
