// SPDX-License-Identifier: Apache-2.0
#include "terrain/clipmap.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "shared/bindings.h"
#include "shared/surface.h"
#include "terrain/land_textures.h"
#include "terrain/mask_mips.h"

namespace sward::terrain {

namespace {

int level_count(const scene::Heightfield& elevation) {
    const glm::dvec2 extent = elevation.extent_m();
    const double reach = std::max(extent.x, extent.y);
    const int levels =
        1 +
        static_cast<int>(std::ceil(std::log2(std::max(reach / (54 * Clipmap::kFinest_m), 1.0))));
    return std::clamp(levels, 6, shared::kMaxClipLevels);
}

gl::Texture posts_texture(const scene::Heightfield& elevation) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (elevation.width > limit || elevation.height > limit) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("elevation: found {} x {} posts, expected at most {} a side",
                                      elevation.width, elevation.height, limit));
    }
    gl::Texture texture(GL_R32F, {elevation.width, elevation.height});
    texture.upload(0, GL_RED, GL_FLOAT, elevation.metres.data());
    texture.set_filter(GL_NEAREST, GL_NEAREST);
    return texture;
}

/// With mips of its own making: what a driver makes of odd sizes loses or shifts a row.
gl::Texture mask_texture(const scene::DensityMask& mask) {
    if (mask.width < 1) {
        gl::Texture none(GL_R8, {1, 1});
        static constexpr float kOne = 1;
        none.upload(0, GL_RED, GL_FLOAT, &kOne);
        return none;
    }
    glm::ivec2 size(mask.width, mask.height);
    gl::TextureShape shape;
    shape.width = size.x;
    shape.height = size.y;
    shape.mips = mip_count(size);
    gl::Texture texture(GL_R8, shape);
    texture.upload(0, GL_RED, GL_FLOAT, mask.density.data());
    std::vector<float> texels;
    for (int mip = 1; mip < shape.mips; ++mip) {
        texels = next_mip(mip == 1 ? mask.density : texels, size);
        texture.upload(mip, GL_RED, GL_FLOAT, texels.data());
    }
    texture.set_filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    texture.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    if (mask.outside)
        go_on_with(texture, {static_cast<float>((*mask.outside)[0]) / 255, 0, 0, 0});
    return texture;
}

gl::Texture level_texture(std::uint32_t format, int levels) {
    gl::Texture texture(format, {shared::kClipCells, shared::kClipCells, levels});
    texture.set_filter(GL_LINEAR, GL_LINEAR);
    texture.set_wrap(GL_REPEAT, GL_REPEAT);
    return texture;
}

} // namespace

GroundSource::GroundSource(const Surface& ground, const scene::DensityMask& density)
    : surface(ground), elevation(posts_texture(ground.elevation())), mask(mask_texture(density)),
      land(land_textures(density)),
      height_program("clipmap height", {"terrain/clipmap_height.comp"}),
      surface_program("clipmap surface", {"terrain/clipmap_surface.comp"}),
      mask_first(density.first_m), mask_size(density.size_m),
      mask_mode(density.width < 1 ? shared::kMaskNone
                : density.bounded ? shared::kMaskBounded
                                  : shared::kMaskEndless) {
    if (mask_size.x <= 0 || mask_size.y <= 0) { // spread over all of the posts
        mask_size = ground.elevation().extent_m();
        mask_first = -0.5 * mask_size;
    }
    land_frame = land_constants(density, mask_size);
}

Clipmap::Clipmap(const std::shared_ptr<GroundSource>& source)
    : source_(source), windows_(static_cast<std::size_t>(level_count(source->surface.elevation()))),
      heights_(level_texture(GL_R32F, levels())), surfaces_(level_texture(GL_RGBA8, levels())),
      params_(sizeof(shared::SurfaceParams)) {}

void Clipmap::update(glm::dvec2 eye) {
    for (int level = 0; level < levels(); ++level) {
        const glm::dvec2 snapped =
            glm::round(eye / (spacing(level) * kSnapCells)) * static_cast<double>(kSnapCells);
        const Window window{glm::ivec2(snapped) - shared::kClipCells / 2};
        Window& present = windows_[static_cast<std::size_t>(level)];
        if (!filled_ || window != present) {
            present = window;
            fill(level);
        }
    }
    filled_ = true;
}

void Clipmap::fill(int level) {
    const scene::Heightfield& posts = source_->surface.elevation();
    const auto index = static_cast<std::size_t>(level);
    shared::SurfaceParams params{};
    params.posts = {posts.width, posts.height};
    params.post_m = glm::vec2(posts.spacing_m);
    params.relief_m = static_cast<float>(source_->surface.relief_m());
    params.first = windows_[index].first;
    params.level = level;
    params.spacing_m = static_cast<float>(spacing(level));
    params_.upload(&params, sizeof(params));
    params_.bind_uniform(BIND_SURFACE);
    source_->elevation.bind(TEX_ELEVATION);
    constexpr GLuint kGroups = shared::kClipCells / CLIP_GROUP;
    source_->height_program.use();
    glBindImageTexture(0, heights_.id(), 0, GL_FALSE, level, GL_WRITE_ONLY, GL_R32F);
    glDispatchCompute(kGroups, kGroups, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    source_->surface_program.use();
    heights_.bind(TEX_CLIP_HEIGHT);
    glBindImageTexture(0, surfaces_.id(), 0, GL_FALSE, level, GL_WRITE_ONLY, GL_RGBA8);
    glDispatchCompute(kGroups, kGroups, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void Clipmap::bind() const {
    heights_.bind(TEX_CLIP_HEIGHT);
    surfaces_.bind(TEX_CLIP_SURFACE);
    source_->mask.bind(TEX_MASK);
    source_->land[0].bind(TEX_LAND_COVER);
    source_->land[1].bind(TEX_LAND_GROUND);
}

void Clipmap::bind_posts(glm::dvec2 anchor, Detail detail) {
    const scene::Heightfield& posts = source_->surface.elevation();
    shared::SurfaceParams params{};
    params.posts = {posts.width, posts.height};
    params.post_m = glm::vec2(posts.spacing_m);
    params.relief_m = static_cast<float>(source_->surface.relief_m());
    params.anchor = glm::vec2(anchor);
    params.detail_from_m = detail.start_m;
    params.zoom = detail.zoom;
    params_.upload(&params, sizeof(params));
    params_.bind_uniform(BIND_SURFACE);
    source_->elevation.bind(TEX_ELEVATION);
}

void Clipmap::describe(shared::FrameConstants& frame, glm::dvec2 anchor) const {
    frame.clip_levels = levels();
    frame.mask_mode = source_->mask_mode;
    frame.land_texel_m = source_->land_frame.x;
    frame.land_highest = source_->land_frame.y;
    frame.land_uneven = source_->land_frame.z;
    frame.mask_offset = glm::vec2((anchor - source_->mask_first) / source_->mask_size);
    frame.mask_per_m = glm::vec2(1.0 / source_->mask_size);
    for (int level = 0; level < levels(); ++level) {
        const double period = spacing(level) * shared::kClipCells;
        // Post g is the centre of texel g mod 128: half a texel further.
        const glm::dvec2 offset = glm::fract(anchor / period) + 0.5 / shared::kClipCells;
        frame.clip[level] = {glm::vec2(offset), static_cast<float>(1 / period),
                             static_cast<float>(spacing(level))};
    }
}

void Clipmap::reload() {
    source_->height_program.reload();
    source_->surface_program.reload();
    filled_ = false;
}

} // namespace sward::terrain
