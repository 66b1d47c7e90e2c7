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

/// The wind far from all that is local: what a weather report says.
struct MeanWind {
    double speed_mps = 4;
    double direction_deg = 270; ///< where it comes from
    double gust = 0.4;          ///< 0 steady .. 1 violent
};

/// The wind of a scene: ambient gusts everywhere and, where something local stands or pushes, a
/// window of fluid around the eye. wind_at() of the shaders and at() answer the same. Needs a
/// current context in all but at() and field().
class Wind {
public:
    /// `response`: bend of the grass per m/s, 1 / (m/s). `inputs` may be null: then nothing is
    /// local.
    Wind(const scene::WindSpec& spec, double response,
         std::unique_ptr<FluidInputs> inputs = nullptr);
    ~Wind();

    /// Runs whole steps until the states cover `time_s` (s, from 0); `eye` is world x, z. What
    /// follows from the same inputs has the same bits at any number of calls. An earlier time
    /// begins anew from 0, and a leap of more than kLeap_s close to its end. `most_steps` of the
    /// window in this call (0: any number); the window then lags behind. Throws
    /// base::Error(kBadInput) for a time or place that is not finite.
    void advance(double time_s, glm::dvec2 eye, int most_steps = 0);
    /// Another mean wind, from the present time on: the air's speed is the new one at once, the
    /// gusts that are under way are carried on with it and grow or weaken. Once it has not changed
    /// for kSettled_s, the gusts that a scene with this wind would have by now are made up for on
    /// the side, a step more a call of advance() than fall due in it, and take the place of the old
    /// ones while these fade. What then blows is bit for bit what a scene blows that began so, but
    /// for the local window, in which the past dies away.
    void set_mean(const MeanWind& wind);
    /// Whether what blows is what a scene that began with the present mean wind blows.
    [[nodiscard]] bool settled() const { return change_ == Change::kNone; }
    /// Binds what lib/wind.glsl reads. Before: advance().
    void bind() const;
    /// Constants for shaders whose xz are relative to `anchor` (world metres), at `time_s`, from
    /// the present states.
    [[nodiscard]] shared::WindField field(glm::dvec2 anchor, double time_s) const;

    /// Velocity (m/s; x east, z south) at world x, z, from the states that have come back from the
    /// GPU: those of a frame or two ago, the first state before that. Between states it is
    /// interpolated, outside of them the nearest answers. Never waits.
    [[nodiscard]] glm::dvec2 at(double x, double z, double time_s) const;
    /// Waits until at() knows the present states: for tests and for work without a clock.
    void wait();

    /// Null while nothing is local.
    [[nodiscard]] const Window* window() const { return window_.get(); }
    [[nodiscard]] const AmbientTile& ambient() const { return *ambient_; }
    [[nodiscard]] FluidInputs* inputs() const { return inputs_.get(); }
    [[nodiscard]] double lag_s(double time_s) const; ///< of the window behind a time; 0 without one
    /// Recompiles what is compiled; throws base::Error for the first that fails.
    void reload();

    static constexpr double kLeap_s = 3600; ///< longer leaps are not stepped through...
    static constexpr double kRunUp_s = 60;  ///< ...but for this long before their end
    static constexpr double kSettled_s =
        0.5; ///< that a changed wind blows before its gusts are made
    static constexpr double kFade_s =
        1; ///< in which the old gusts fade, and again the new ones come
    /// That a window goes on when nothing is local any more: what was stirred dies away, and in the
    /// last second the window fades.
    static constexpr double kLinger_s = 5;

private:
    void restart(double time_s);
    void step_ambient(double time_s);
    void advance_window(double time_s, glm::dvec2 eye, int most_steps);
    [[nodiscard]] bool wants_window(double time_s);
    [[nodiscard]] double window_fade(double time_s) const;
    [[nodiscard]] shared::WindField compose(glm::dvec2 anchor, double time_s,
                                            const StateTag& ambient, const StateTag& window) const;
    void point_textures();
    [[nodiscard]] glm::dvec2 carried(double time_s) const {
        return drift_ + mean_ * (time_s - drift_from_s_);
    }
    [[nodiscard]] double gust_gain(double time_s) const;
    void begin_gusts(std::unique_ptr<AmbientTile> tile);
    void settle(double time_s);

    scene::WindSpec spec_;
    double response_;
    glm::dvec2 mean_{0};                    ///< m/s
    glm::dvec2 shift_[shared::kWindLayers]; ///< of the layers, cells
    std::unique_ptr<FluidInputs> inputs_;
    std::unique_ptr<AmbientTile> ambient_;
    std::unique_ptr<Window> window_;
    std::unique_ptr<ReadBack> ambient_back_;
    std::unique_ptr<ReadBack> window_back_;
    double time_s_ = 0;
    double stirred_s_ = 0; ///< when something local was last there
    int cells_ = 0;        ///< a side of the window, as the inputs ask for it
    std::optional<glm::dvec2> eye_;
    std::uint32_t textures_[2] = {0, 0};
    // A change of the mean wind.
    enum class Change { kNone, kBlows, kFades, kComes };
    Change change_ = Change::kNone;
    double change_s_ = 0; ///< when it came to this
    glm::dvec2 drift_{0}; ///< how far the air had been carried (m) at drift_from_s_
    double drift_from_s_ = 0;
    double gain_ = 1;                   ///< of the old gusts: to the new wind's strength
    std::unique_ptr<AmbientTile> next_; ///< gusts that are made up for
};

} // namespace sward::wind
