// SPDX-License-Identifier: Apache-2.0
#include "app/weather.h"

#include <algorithm>
#include <cmath>

namespace sward::app {
namespace {

double wrapped(double value, double whole) {
    return value - whole * std::floor(value / whole);
}

} // namespace

Weather::Weather(const scene::Scene& scene, double latitude_deg)
    : day(scene.sun, latitude_deg),
      hour(day.hour()), wind{scene.wind.speed_mps, scene.wind.direction_deg, scene.wind.gust} {}

Sun Weather::sun() const {
    const scene::SunSpec at = day.at(hour);
    return {at.azimuth_deg, at.elevation_deg};
}

void Weather::act(Action action) {
    switch (action) {
    case Action::kEarlier:
        hour = wrapped(hour - kHourStep, 24);
        break;
    case Action::kLater:
        hour = wrapped(hour + kHourStep, 24);
        break;
    case Action::kMoreWind:
        wind.speed_mps = std::min(kMostWind_mps, wind.speed_mps + kWindStep_mps);
        break;
    case Action::kLessWind:
        wind.speed_mps = std::max(0.0, wind.speed_mps - kWindStep_mps);
        break;
    case Action::kWindLeft:
        wind.direction_deg = wrapped(wind.direction_deg - kTurnStep_deg, 360);
        break;
    case Action::kWindRight:
        wind.direction_deg = wrapped(wind.direction_deg + kTurnStep_deg, 360);
        break;
    default:
        break;
    }
}

} // namespace sward::app
