// SPDX-License-Identifier: Apache-2.0
#include "app/cockpit_line.h"

#include <cmath>

#include <fmt/format.h>

namespace sward::app {
namespace {

std::string number(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

/// Three figures, and never "360".
std::string heading(double degrees) {
    if (!std::isfinite(degrees))
        return "-";
    const double turn = degrees - 360 * std::floor(degrees / 360);
    return fmt::format("{:03}", static_cast<int>(std::floor(turn + 0.5)) % 360);
}

std::string pace(const CockpitFacts& facts) {
    if (facts.paused)
        return "  PAUSED";
    if (facts.rate == 1)
        return {};
    return facts.rate < 1 ? fmt::format("  TIME 1/{:.0f}", 1 / facts.rate)
                          : fmt::format("  TIME x{:.0f}", facts.rate);
}

} // namespace

std::string short_count(std::uint64_t count) {
    const auto value = static_cast<double>(count);
    if (count < 1000)
        return fmt::format("{}", count);
    if (value < 99'950)
        return fmt::format("{:.1f}k", value / 1e3);
    if (value < 999'500)
        return fmt::format("{:.0f}k", value / 1e3);
    return fmt::format("{:.1f}M", value / 1e6);
}

std::string cockpit_line(const CockpitFacts& facts) {
    const int digits = std::abs(facts.above_ground_m) < 100 ? 1 : 0;
    return fmt::format("{} km/h  {} m above ground  hdg {}  |  {}/{} ms  |  living {}  drawn {}  "
                       "far {} px  |  {}  t {} s{}{}",
                       number(facts.speed_mps * 3.6, 0), number(facts.above_ground_m, digits),
                       heading(facts.heading_deg), number(facts.p50_ms, 1), number(facts.p99_ms, 1),
                       short_count(facts.living), short_count(facts.drawn),
                       short_count(facts.marched), facts.hour, number(facts.time_s, 1), pace(facts),
                       facts.note.empty() ? "" : "  |  " + facts.note);
}

} // namespace sward::app
