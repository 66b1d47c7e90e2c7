// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/image.h"
#include "scene/scene.h"
#include "tracks/page_memory.h"
#include "tracks/pages.h"
#include "tracks/print_list.h"
#include "tracks/track_pass.h"

namespace sward::tracks {

/// What has passed through a scene's grass (methods.md C1 to C6): steps of a fixed length counted
/// from time 0, whatever the pictures' rate. Needs a current context.
class Tracks {
public:
    /// Balls in the step that ends at a time.
    using Balls = std::function<std::vector<Ball>(double time_s, double step_s)>;
    struct Inputs {
        Ground ground;
        Balls balls; ///< may be null
    };
    /// The scene has `tracks`. `canopy_m`: what does not come below it touches nothing.
    Tracks(const scene::Scene& scene, double canopy_m, Inputs inputs);

    /// Whole steps up to `time_s` (s, from 0); pages in and out around what moves and the eyes
    /// (world metres). An earlier time begins anew. Of a leap of more than kLeap_s only its end is
    /// stepped in full; of what was before it what lies pressed is kept.
    void advance(double time_s, std::span<const glm::dvec3> eyes);
    /// Binds what lib/track.glsl reads. Before: advance().
    void bind() const { pass_.bind(); }
    /// Constants for shaders whose xz are relative to `anchor` (world x, z).
    [[nodiscard]] shared::TrackField field(glm::dvec2 anchor) const;

    struct Sample {
        glm::vec2 theta{0}, pressed{0};
    };
    /// The cell at world x, z. Waits for the GPU.
    [[nodiscard]] Sample at(double x, double z) const;

    /// What lies, as a picture: channels pressed.X and pressed.Y over the pages that hold some, a
    /// pixel a cell, north up. Throws Error(kOverLimit) where it would have more than kMostSide
    /// pixels a side. Width 0: nothing lies.
    [[nodiscard]] scene::Image picture() const;
    /// Takes such a picture as what lay at time 0, in the place of what there is. Throws
    /// Error(kBadInput) that begins with `name` for one of another kind, cell size or place.
    void begin_with(const scene::Image& picture, const std::string& name);
    static constexpr int kMostSide = 16384;

    [[nodiscard]] const Pages& pages() const { return pages_; }
    [[nodiscard]] const PageMemory& memory() const { return memory_; }
    [[nodiscard]] std::size_t bytes() const { return pass_.bytes(); }
    [[nodiscard]] std::size_t refused() const {
        return refused_;
    } ///< pages that something touched and that had no room
    [[nodiscard]] std::size_t stilled() const {
        return stilled_;
    } ///< blocks whose bends were given up for others'
    [[nodiscard]] std::uint64_t stepped_blocks() const { return stepped_; }
    [[nodiscard]] std::size_t moving() const { return places_used_; } ///< blocks
    /// Blocks that can move at a time: of a page that a wheel crosses, and the ways beside it, 17
    /// of 64 do.
    static constexpr int kMovingBlocksAPage = 17;
    [[nodiscard]] const shared::TrackRules& rules() const { return rules_; }
    void reload() { pass_.reload(); }

    static constexpr double kLeap_s = 10;

private:
    using Block = Pages::Block;
    void forget();
    void restart();
    void step(std::int64_t number, bool full);
    void settle(std::int64_t number);
    void follow_epoch(double time_s);
    void wake(const std::vector<Print>& prints, std::int64_t number, bool full);
    void wake_blocks(int slot, const Print& print, std::int64_t until);
    int take_place(std::int64_t until);
    void lay_to_rest(Block& block);
    [[nodiscard]] TrackPass::Work work_of(const std::vector<Print>& prints,
                                          std::int64_t number) const;
    [[nodiscard]] int place_of(PageKey key, glm::ivec2 block) const;
    int bring(PageKey key, std::span<const PageKey> kept);
    void restore(int slot, PageContent content);
    void drop(int slot);
    void bring_back();
    void show();
    [[nodiscard]] std::vector<glm::vec2> lying(PageKey key) const;

    scene::TrackSpec spec_;
    PrintList prints_;
    Inputs inputs_;
    Pages pages_;
    PageMemory memory_;
    TrackPass pass_;
    shared::TrackRules rules_{};
    std::int64_t done_ = -1, settle_steps_ = 0, epoch_ = 0;
    std::vector<glm::dvec2> eyes_;
    std::optional<scene::Image> first_; ///< what lay at time 0
    std::string first_name_;
    double time_s_ = 0;
    std::vector<int> free_places_; ///< of the pool of what moves
    int places_ever_ = 0;          ///< those in use and free ones
    std::size_t places_used_ = 0;
    std::size_t refused_ = 0, stilled_ = 0;
    std::uint64_t stepped_ = 0;
    bool table_changed_ = true, told_ = false;
};

/// Attribute of the pictures: cell (m); number of the first page east, south.
inline constexpr const char* kPictureKey = "sward:tracks";
/// Steps until a bend of 1 is less than a thousandth, by a cell's own rules; at most a minute's.
[[nodiscard]] std::int64_t steps_to_rest(const shared::TrackRules& rules);
/// C2's constants as the passes take them.
[[nodiscard]] shared::TrackRules rules_of(const scene::TrackSpec& spec, double canopy_m);

} // namespace sward::tracks
