// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "scene/heightfield.h"
#include "shared/frame.h"
#include "terrain/detail.h"
#include "terrain/surface.h"

namespace sward::terrain {

/// What every clipmap of a land reads: its posts and its mask on the GPU, the programs that
/// evaluate them.
struct GroundSource {
    /// `mask` may be empty (width 0): the slope rule. Throws Error(kOverLimit) when the posts
    /// exceed a texture.
    GroundSource(const Surface& surface, const scene::DensityMask& mask);
    const Surface& surface;
    gl::Texture elevation, mask;
    std::array<gl::Texture, 2> land; ///< LandByte 0 to 3, 4 to 7
    gl::Program height_program, surface_program;
    glm::dvec2 mask_first, mask_size; ///< world metres
    int mask_mode;                    ///< kMask*
    glm::vec4 land_frame; ///< FrameConstants: land_texel_m, land_highest, land_uneven; unused
};

/// The ground around the eye as nested grids (geometry clipmap, Losasso & Hoppe 2004): level k has
/// kClipCells posts a side, 0.5 m * 2^k apart, in textures that wrap around, so that moving the eye
/// moves no post. shaders/lib/ground.glsl reads it.
class Clipmap {
public:
    static constexpr double kFinest_m = 0.5;
    static constexpr int kSnapCells =
        2 * shared::kBlockCells; ///< so that the hole for a finer level falls on blocks

    /// Level windows: world index of the first post.
    struct Window {
        glm::ivec2 first{0, 0};
        bool operator==(const Window&) const = default;
    };

    /// Of a land that others look at too.
    explicit Clipmap(const std::shared_ptr<GroundSource>& source);
    /// Of one of its own. Throws Error as GroundSource does.
    Clipmap(const Surface& surface, const scene::DensityMask& mask)
        : Clipmap(std::make_shared<GroundSource>(surface, mask)) {}

    /// Brings every level's window around the eye (world metres); recomputes the levels that moved.
    void update(glm::dvec2 eye);
    void bind() const;
    /// For programs with FINE_GROUND, after update(): the posts themselves. `anchor` in world
    /// metres.
    void bind_posts(glm::dvec2 anchor, Detail detail);
    /// Fills clip, clip_levels, mask_mode, mask_offset and mask_per_m of the frame constants for an
    /// anchor (world metres).
    void describe(shared::FrameConstants& frame, glm::dvec2 anchor) const;

    [[nodiscard]] int levels() const { return static_cast<int>(windows_.size()); }
    [[nodiscard]] static double spacing(int level) {
        return kFinest_m * static_cast<double>(1 << level);
    }
    [[nodiscard]] const Window& window(int level) const {
        return windows_[static_cast<std::size_t>(level)];
    }
    [[nodiscard]] const gl::Texture& heights() const { return heights_; }
    /// Recompiles the source's programs, and fills all levels with the next update.
    void reload();
    /// Fills all levels with the next update: another clipmap has recompiled the source's programs.
    void refill() { filled_ = false; }

private:
    void fill(int level);
    std::shared_ptr<GroundSource> source_;
    std::vector<Window> windows_;
    bool filled_ = false;
    gl::Texture heights_, surfaces_;
    gl::Buffer params_;
};

} // namespace sward::terrain
