// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/wind_spec.h"

namespace sward::scene {

/// Which end of an arrow.
enum class ArrowEnd { kRoot, kTip };
struct ArrowHandle {
    std::size_t arrow = 0;
    ArrowEnd end = ArrowEnd::kTip;
    bool operator==(const ArrowHandle&) const = default;
};

/// The wind's arrows under edit (methods.md W5): points are added, moved and deleted, every change
/// can be undone. Whatever is done, the arrows stay what a scene file may hold: unique ids, parents
/// that are there and come first in no loop, lengths above kLeastLength_m, numbers in their ranges.
/// No window, no GL.
class ArrowEdit {
public:
    static constexpr double kLeastLength_m = 0.05;
    static constexpr std::size_t kMostArrows = 1024;
    static constexpr std::size_t kMostUndo = 256; ///< older changes cannot be undone

    explicit ArrowEdit(std::vector<WindArrow> arrows)
        : arrows_(std::move(arrows)), saved_(arrows_) {}

    [[nodiscard]] const std::vector<WindArrow>& arrows() const { return arrows_; }
    [[nodiscard]] glm::dvec2 place(ArrowHandle handle) const;
    /// The point nearest to `at` within `reach_m`; of a tip and the roots that continue it, the
    /// tip.
    [[nodiscard]] std::optional<ArrowHandle> nearest(glm::dvec2 at, double reach_m) const;

    /// A new tree; nothing when it would be too short or there are too many. Returns its arrow.
    std::optional<std::size_t> add(glm::dvec2 root, glm::dvec2 tip);
    /// A new arrow that continues `parent` from its tip, as strong and as wide. Likewise.
    std::optional<std::size_t> branch(std::size_t parent, glm::dvec2 tip);
    /// Moves a point and what hangs on it: a tip takes the roots of the arrows that continue it
    /// along. A root that sits on its parent's tip moves that tip. Refused (false) when an arrow
    /// would become too short.
    bool move(ArrowHandle handle, glm::dvec2 to);
    /// Takes an arrow out; those that continued it start where it did. Whoever becomes too short
    /// goes with it.
    void erase(std::size_t arrow);
    /// Takes an arrow out with all that continues it.
    void erase_branch(std::size_t arrow);
    void set_strength(std::size_t arrow, double strength_mps);
    void set_radius(std::size_t arrow, double radius_m);

    /// Changes until end() count as one: a drag, a slider. begin() within begin() does nothing.
    void begin();
    void end() { open_ = Open::kNo; }
    bool undo();
    bool redo();
    [[nodiscard]] bool can_undo() const { return !before_.empty(); }
    [[nodiscard]] bool can_redo() const { return !after_.empty(); }

    /// Whether the arrows differ from those at the start or at the last set_saved().
    [[nodiscard]] bool unsaved() const { return arrows_ != saved_; }
    void set_saved() { saved_ = arrows_; }

private:
    enum class Open { kNo, kFresh, kChanged };
    using State = std::vector<WindArrow>;
    /// Makes `next` the present state, the old one can be undone to.
    void commit(State next);
    [[nodiscard]] std::optional<std::size_t> append(WindArrow arrow);
    [[nodiscard]] std::size_t index_of(const std::string& id) const;
    [[nodiscard]] std::string free_id() const;

    State arrows_, saved_;
    std::vector<State> before_, after_;
    Open open_ = Open::kNo;
};

} // namespace sward::scene
