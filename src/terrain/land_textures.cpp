// SPDX-License-Identifier: Apache-2.0
#include "terrain/land_textures.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "terrain/mask_mips.h"

namespace sward::terrain {
namespace {

constexpr std::size_t kChannels = 4;

/// Four of the bytes of each texel, from `first` on.
std::vector<std::uint8_t> part_of(const std::vector<std::uint8_t>& land, std::size_t first) {
    std::vector<std::uint8_t> part;
    part.reserve(land.size() / 2);
    for (std::size_t at = first; at < land.size(); at += scene::kLandBytes)
        part.insert(part.end(), land.data() + at, land.data() + at + kChannels);
    return part;
}

gl::Texture texture_of(std::vector<std::uint8_t> texels, glm::ivec2 size) {
    gl::TextureShape shape;
    shape.width = size.x;
    shape.height = size.y;
    shape.mips = mip_count(size);
    gl::Texture texture(GL_RGBA8, shape);
    texture.upload(0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    for (int mip = 1; mip < shape.mips; ++mip) {
        texels = next_mip(texels, size);
        texture.upload(mip, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
    texture.set_filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    texture.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    return texture;
}

} // namespace

std::array<gl::Texture, 2> land_textures(const scene::DensityMask& mask) {
    if (mask.land.empty()) {
        static constexpr std::array<std::uint8_t, kChannels> kNone = {128, 128, 0, 0};
        return {texture_of({kNone.begin(), kNone.end()}, {1, 1}), texture_of({0, 0, 0, 0}, {1, 1})};
    }
    const glm::ivec2 size(mask.width, mask.height);
    std::array<gl::Texture, 2> textures = {texture_of(part_of(mask.land, 0), size),
                                           texture_of(part_of(mask.land, kChannels), size)};
    if (mask.outside) {
        const auto& bytes = *mask.outside;
        go_on_with(textures[0], glm::vec4(bytes[1], bytes[2], bytes[3], bytes[4]) / 255.0f);
        go_on_with(textures[1], glm::vec4(bytes[5], bytes[6], bytes[7], bytes[8]) / 255.0f);
    }
    return textures;
}

void go_on_with(gl::Texture& texture, glm::vec4 colour) {
    texture.set_wrap(GL_CLAMP_TO_BORDER, GL_CLAMP_TO_BORDER);
    glTextureParameterfv(texture.id(), GL_TEXTURE_BORDER_COLOR, &colour.x);
}

glm::vec4 land_constants(const scene::DensityMask& mask, glm::dvec2 size_m) {
    if (mask.land.empty())
        return {0, 1, 0, 0};
    const glm::dvec2 texel = size_m / glm::dvec2(mask.width, mask.height);
    return {static_cast<float>(std::max(texel.x, texel.y)), static_cast<float>(mask.highest),
            mask.heights ? 1.0f : 0.0f, 0};
}

} // namespace sward::terrain
