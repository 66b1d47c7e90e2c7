// SPDX-License-Identifier: Apache-2.0
#include "shells/far_textures.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "grass/bc5.h"

namespace sward::shells {

namespace {

/// Where the images of an array end that this GPU takes.
void check_images(const grass::TextureArray& array) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
    if (array.layers > limit) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("grass set: found {} images in one array, this GPU takes {}",
                                      array.layers, limit));
    }
}

gl::Texture upload(const grass::TextureArray& array, std::uint32_t wrap_t) {
    check_images(array);
    const bool blocks = array.format == grass::TexelFormat::kBc5;
    const std::uint32_t format = blocks ? GL_COMPRESSED_RG_RGTC2 : GL_RGBA8;
    const int mips = static_cast<int>(array.mips.size());
    gl::Texture texture(format, {array.width, array.height, array.layers, mips});
    for (int mip = 0; mip < mips; ++mip) {
        const std::vector<std::uint8_t>& data = array.mips[static_cast<std::size_t>(mip)];
        if (blocks) {
            texture.upload_blocks(mip, format, data.data(), data.size());
        } else {
            texture.upload(mip, GL_RGBA, GL_UNSIGNED_BYTE, data.data());
        }
    }
    // A texel belongs to one blade: ranks and roots must not be averaged.
    texture.set_filter(GL_NEAREST_MIPMAP_NEAREST, GL_NEAREST);
    texture.set_wrap(GL_REPEAT, wrap_t);
    return texture;
}

} // namespace

FarTextures::FarTextures(const grass::GrassSet& set) {
    for (const grass::FarLevel& level : set.levels) {
        if (level.layers_shape.mips.empty()) {
            levels_.push_back({upload(level.layers, GL_REPEAT),
                               upload(level.slices, GL_CLAMP_TO_EDGE),
                               {},
                               {},
                               level.layer_count,
                               level.slice_count});
            continue;
        }
        block_shapes_ = true; // of all levels: the reader sees to it
        levels_.push_back({upload(grass::id_planes(level.layers), GL_REPEAT),
                           upload(grass::id_planes(level.slices), GL_CLAMP_TO_EDGE),
                           upload(level.layers_shape, GL_REPEAT),
                           upload(level.slices_shape, GL_CLAMP_TO_EDGE), level.layer_count,
                           level.slice_count});
    }
}

} // namespace sward::shells
