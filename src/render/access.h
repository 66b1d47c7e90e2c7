// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "render/view_state.h"
#include "sward/view.h"

namespace sward::render {

/// What is behind a Field: its source while it loads, then its state.
struct FieldInside {
    FieldSource source;
    std::optional<World> world; ///< as far as it is read
    int done = 0;               ///< steps of prepare()
    std::shared_ptr<FieldState> state;
    bool wait_in_passes = false; ///< SimulationSettings::wait_in_passes
};

struct ViewInside {
    std::shared_ptr<FieldInside> field;
    FrameSettings settings; ///< of the next picture; its size is the target's
    ViewState state;
};

/// What a frame of one view, drawn with these, wants of its simulation.
[[nodiscard]] inline SimulationLimits limits_of(const FrameSettings& settings) {
    return {settings.physics && draws_blades(settings), settings.simulated_radius_m,
            settings.most_simulated_bytes, settings.most_physics_steps, settings.most_wind_steps};
}

/// The way of Sward's own programs and tests behind the face: tests' switches, AOVs, statistics.
struct Access {
    /// A field of a world that is read already. Needs a current context. Throws base::Error.
    [[nodiscard]] static Field field_of(World world);
    [[nodiscard]] static FieldState& state(Field& field) { return *field.inside_->state; }
    [[nodiscard]] static FieldInside& inside(Field& field) { return *field.inside_; }
    [[nodiscard]] static std::shared_ptr<FieldInside> share(Field& field) { return field.inside_; }
    [[nodiscard]] static ViewState& state(View& view) { return view.inside_->state; }
    [[nodiscard]] static FrameSettings& settings(View& view) { return view.inside_->settings; }
};

} // namespace sward::render
