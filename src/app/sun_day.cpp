// SPDX-License-Identifier: Apache-2.0
#include "app/sun_day.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "base/angles.h"

namespace sward::app {
namespace {

using base::kDegree;
constexpr double kHour = 15 * kDegree;            // the Earth turns so far
constexpr double kHighestLatitude = 89 * kDegree; // at a pole there is no south

double wrapped(double hour) {
    return hour - 24 * std::floor(hour / 24);
}

} // namespace

SunDay::SunDay(const scene::SunSpec& sun, double latitude_deg)
    : latitude_(std::clamp(latitude_deg * kDegree, -kHighestLatitude, kHighestLatitude)) {
    const double azimuth = sun.azimuth_deg * kDegree, elevation = sun.elevation_deg * kDegree;
    // From the horizon's frame (east, north, up) to the equator's: the angle to its plane is the
    // declination, that around its axis the hour.
    const double east = std::sin(azimuth) * std::cos(elevation),
                 north = std::cos(azimuth) * std::cos(elevation), up = std::sin(elevation);
    const double sin_lat = std::sin(latitude_), cos_lat = std::cos(latitude_);
    declination_ = std::asin(std::clamp(north * cos_lat + up * sin_lat, -1.0, 1.0));
    hour_ = wrapped(12 + std::atan2(-east, up * cos_lat - north * sin_lat) / kHour);
}

scene::SunSpec SunDay::at(double hour) const {
    const double angle = (hour - 12) * kHour, sin_lat = std::sin(latitude_),
                 cos_lat = std::cos(latitude_);
    const double out = std::cos(declination_) * std::cos(angle); // towards the meridian
    const double east = -std::cos(declination_) * std::sin(angle);
    const double north = std::sin(declination_) * cos_lat - out * sin_lat;
    const double up = std::sin(declination_) * sin_lat + out * cos_lat;
    const double azimuth = std::atan2(east, north) / kDegree;
    return {azimuth - 360 * std::floor(azimuth / 360),
            std::asin(std::clamp(up, -1.0, 1.0)) / kDegree};
}

std::string hour_text(double hour) {
    const auto minutes = static_cast<int>(std::floor(wrapped(hour) * 60 + 0.5)) % (24 * 60);
    return fmt::format("{:02}:{:02}", minutes / 60, minutes % 60);
}

} // namespace sward::app
