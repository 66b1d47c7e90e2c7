// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace sward::app {

/// The day on which a scene's sun stands where it does, at a latitude: where it stands at other
/// hours of it. The scene's own hour gives the scene's own sun.
class SunDay {
public:
    SunDay(const scene::SunSpec& sun, double latitude_deg);
    /// Of the scene's sun: solar time, 0 to 24; 12 is when it stands highest.
    [[nodiscard]] double hour() const { return hour_; }
    [[nodiscard]] scene::SunSpec at(double hour) const;

    static constexpr double kUsualLatitude_deg = 45; ///< of terrains without a place on Earth

private:
    double latitude_, declination_; ///< radians
    double hour_;
};

/// "14:05" of 14.09; hours wrap.
[[nodiscard]] std::string hour_text(double hour);

} // namespace sward::app
