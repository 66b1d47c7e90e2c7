// SPDX-License-Identifier: Apache-2.0
#include "shells/far_textures.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"

namespace sward::shells {

namespace {

gl::Texture upload(const grass::TextureArray& array, std::uint32_t wrap_t) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
    if (array.layers > limit) {
        throw base::Error(base::ExitCode::kOverLimit, fmt::format("grass set: found {} images in one array, this GPU takes {}", array.layers, limit));
    }
    const int mips = static_cast<int>(array.mips.size());
    gl::Texture texture(GL_RGBA8, {array.width, array.height, array.layers, mips});
    for (int mip = 0; mip < mips; ++mip) {
        texture.upload(mip, GL_RGBA, GL_UNSIGNED_BYTE, array.mips[static_cast<std::size_t>(mip)].data());
    }
    // A texel belongs to one blade: ranks and roots must not be averaged.
    texture.set_filter(GL_NEAREST_MIPMAP_NEAREST, GL_NEAREST);
    texture.set_wrap(GL_REPEAT, wrap_t);
    return texture;
}

} // namespace

FarTextures::FarTextures(const grass::GrassSet& set) {
    for (const grass::FarLevel& level : set.levels) {
        levels_.push_back({upload(level.layers, GL_REPEAT), upload(level.slices, GL_CLAMP_TO_EDGE), level.layer_count, level.slice_count});
    }
}

} // namespace sward::shells
