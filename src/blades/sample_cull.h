// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "blades/blade_tiles.h"
#include "blades/physics_pass.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "shared/bindings.h"
#include "shared/sample_places.h"

namespace sward::blades {

/// Culls blades of the reference's jittered pictures by their samples: a blade that none of a
/// picture's samples can fall on is not drawn in it. The test is made once for all pictures of a
/// round, and keeps all that is seen: the pictures are the same, bit by bit. Far off, blades are a
/// hundredth of a pixel wide, and of a hundred one has to be drawn; of those nearly all stand
/// behind others (sift()). 2 bytes a blade in reach, 256 MiB at most, and 2 MiB.
class SampleCull {
public:
    /// Chunks gathered and drawn at once.
    static constexpr std::size_t kBatch = 2048;
    /// Chunks whose choice is kept; of a longer list each picture makes its own, batch by batch.
    static constexpr std::size_t kMostKept = std::size_t{1} << 20;
    static constexpr int kRound = shared::kRoundPictures;

    SampleCull();
    /// The blades of a round of pictures. `samples`: places of a pixel's samples, kMostSamples at
    /// most; `jitters`: what each picture of the round moves by against the first one, in pixels;
    /// kRound at most. `keep_total`: a later round of the same frame.
    void upload(const TileList& list, std::span<const glm::vec2> samples,
                std::span<const glm::vec2> jitters, bool keep_total);
    /// Before, also of gather(): frame constants of the round's first picture, clipmap, wind and
    /// the blades are bound. `living`: null where no blade lives.
    void choose(const PhysicsPass* living);
    [[nodiscard]] std::size_t batches() const { return (items_count_ + kBatch - 1) / kBatch; }
    /// True where choose() keeps nothing and gather() works with the bound picture's own constants.
    [[nodiscard]] bool piecewise() const { return items_count_ > kMostKept; }
    /// Then the batch's survivors and draw commands of the round's `picture` are ready.
    void gather(std::size_t batch, int picture, const PhysicsPass* living);
    /// Takes from the batch what a picture so far, whose depth it is, hides. Before, beside
    /// gather() and what it wants: the picture's own constants are bound. Batches come from near to
    /// far.
    void sift(const gl::Texture& depth, const PhysicsPass* living);
    /// By CULL_*, of all pictures since the count began. Waits for the GPU.
    [[nodiscard]] std::array<std::uint32_t, CULL_COUNTS> counts() const;
    [[nodiscard]] const gl::Buffer& commands() const { return commands_; }
    [[nodiscard]] int command_count() const { return command_count_; }
    [[nodiscard]] const gl::Buffer& survivors() const { return survivors_; }
    void reload();

private:
    void choose_items(std::size_t first, std::size_t end, const PhysicsPass* living);
    gl::Program choose_, gather_, sift_;
    gl::Buffer tiles_, items_, masks_, survivors_, commands_, total_, round_;
    std::size_t items_count_ = 0, first_mask_ = 0;
    int command_count_ = 0;
};

} // namespace sward::blades
