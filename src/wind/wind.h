// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/wind.h"
#include "wind/ambient.h"
#include "wind/read_back.h"
#include "wind/window.h"

namespace sward::wind {

/// The wind of a scene: ambient gusts everywhere and, where something local stands or pushes, a window of fluid around the eye.
/// wind_at() of the shaders and at() answer the same. Needs a current context in all but at() and field().
class Wind {
public:
    /// `response`: bend of the grass per m/s, 1 / (m/s). `inputs` may be null: then nothing is local.
    Wind(const scene::WindSpec& spec, double response, std::unique_ptr<FluidInputs> inputs = nullptr);
    ~Wind();

    /// Runs whole steps until the states cover `time_s` (s, from 0); `eye` is world x, z. What follows from the same inputs has
    /// the same bits at any number of calls. An earlier time begins anew from 0, and a leap of more than kLeap_s close to
    /// its end. `most_steps` of the window in this call (0: any number); the window then lags behind. Throws
    /// base::Error(kBadInput) for a time or place that is not finite.
    void advance(double time_s, glm::dvec2 eye, int most_steps = 0);
    /// Binds what lib/wind.glsl reads. Before: advance().
    void bind() const;
    /// Constants for shaders whose xz are relative to `anchor` (world metres), at `time_s`, from the present states.
    [[nodiscard]] shared::WindField field(glm::dvec2 anchor, double time_s) const;

    /// Velocity (m/s; x east, z south) at world x, z, from the states that have come back from the GPU: those of a frame or two
    /// ago, the first state before that. Between states it is interpolated, outside of them the nearest answers. Never waits.
    [[nodiscard]] glm::dvec2 at(double x, double z, double time_s) const;
    /// Waits until at() knows the present states: for tests and for work without a clock.
    void wait();

    /// Null while nothing is local.
    [[nodiscard]] const Window* window() const { return window_.get(); }
    [[nodiscard]] const AmbientTile& ambient() const { return ambient_; }
    [[nodiscard]] FluidInputs* inputs() const { return inputs_.get(); }
    [[nodiscard]] double lag_s(double time_s) const; ///< of the window behind a time; 0 without one
    /// Recompiles what is compiled; throws base::Error for the first that fails.
    void reload();

    static constexpr double kLeap_s = 3600;  ///< longer leaps are not stepped through...
    static constexpr double kRunUp_s = 60;  ///< ...but for this long before their end

private:
    void restart(double time_s);
    void step_ambient(double time_s);
    void advance_window(double time_s, glm::dvec2 eye, int most_steps);
    [[nodiscard]] shared::WindField compose(glm::dvec2 anchor, double time_s, const StateTag& ambient, const StateTag& window) const;
    void point_textures();

    scene::WindSpec spec_;
    double response_;
    glm::dvec2 mean_{0}; ///< m/s
    glm::dvec2 shift_[shared::kWindLayers]; ///< of the layers, cells
    std::unique_ptr<FluidInputs> inputs_;
    AmbientTile ambient_;
    std::unique_ptr<Window> window_;
    ReadBack ambient_back_;
    std::unique_ptr<ReadBack> window_back_;
    double time_s_ = 0;
    std::optional<glm::dvec2> eye_;
    std::uint32_t textures_[2] = {0, 0};
};

} // namespace sward::wind
