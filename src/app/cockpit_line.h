// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace sward::app {

/// What the line on the picture says.
struct CockpitFacts {
    double speed_mps = 0; ///< of the eye, in simulated or real time, whichever moves it
    double above_ground_m = 0;
    double heading_deg = 0; ///< clockwise from north; any
    double p50_ms = 0, p99_ms = 0;
    std::uint64_t living = 0, drawn = 0,
                  marched = 0; ///< blades with a state, blades as geometry, pixels of the far field
    double time_s = 0;
    std::string hour; ///< of the day
    bool paused = false;
    double rate = 1;
    std::string note; ///< of what moves the eye; empty: none
};

/// One line of plain letters. Numbers that are none are shown as "-".
[[nodiscard]] std::string cockpit_line(const CockpitFacts& facts);

/// "987", "12.3k", "4.5M".
[[nodiscard]] std::string short_count(std::uint64_t count);

} // namespace sward::app
