// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "wind/fluid.h"
#include "wind/state.h"

namespace sward::wind {

/// The local window: an open fluid that follows the eye in whole cells, fed by the ambient wind at
/// its rim.
class Window {
public:
    static constexpr int kMoveCells = 8; ///< it moves when the eye is so far from its centre:
                                         ///< rarely, and by less than the rim's blend

    /// Of `cells` a side, in the place of the spec's.
    Window(const scene::WindSpec& spec, int cells, glm::dvec2 mean_mps);
    /// Another wind from the next step on; of `spec` speed and gust alone.
    void set_mean(const scene::WindSpec& spec, glm::dvec2 mean_mps);

    /// Stands around `eye` with the ambient wind in it, at state `first`.
    void begin(glm::dvec2 eye, std::int64_t first, const shared::WindField& ambient);
    /// The north-west corner (world m) that the window takes for an eye there: the anchor of the
    /// fields below.
    [[nodiscard]] glm::dvec2 corner_for(glm::dvec2 eye) const;
    [[nodiscard]] glm::dvec2 corner() const { return fluid_.grid().origin_m; }
    /// Moves to the corner of an eye (if it is another), its anchor `ambient`'s.
    void follow(glm::dvec2 eye, const shared::WindField& ambient);
    /// One step, with the ambient wind at its end, anchored at the corner.
    void step(FluidInputs& inputs, const shared::WindField& ambient);

    [[nodiscard]] const StateTag& tag() const { return tag_; }
    [[nodiscard]] double next_time_s() const {
        return static_cast<double>(tag_.latest + 1) * tag_.step_s;
    }
    [[nodiscard]] const Fluid& fluid() const { return fluid_; }
    void reload() { fluid_.reload(); }

private:
    [[nodiscard]] glm::ivec2 first_for(glm::dvec2 eye) const;
    Fluid fluid_;
    double calm_mps_;
    StateTag tag_;
};

} // namespace sward::wind
