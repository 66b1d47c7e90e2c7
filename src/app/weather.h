// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/keys.h"
#include "app/sun_day.h"
#include "sward/field.h"

namespace sward::app {

/// Time of day and mean wind of the scene that is shown: what keys and sliders change without a
/// reload.
struct Weather {
    Weather(const scene::Scene& scene, double latitude_deg);

    SunDay day;
    double hour; ///< 0 to 24, solar time
    MeanWind wind;

    [[nodiscard]] Sun sun() const;
    /// Does what a press asks for, if it is about these.
    void act(Action action);

    static constexpr double kHourStep = 0.25, kWindStep_mps = 1, kTurnStep_deg = 10,
                            kMostWind_mps = 60;
};

} // namespace sward::app
