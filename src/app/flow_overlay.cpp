// SPDX-License-Identifier: Apache-2.0
#include "app/flow_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/hash.h"

namespace sward::app {
namespace {

constexpr int kRings = 5; // of squares about the eye, each twice as coarse as the one within
constexpr double kSpacing_m = 1.5; // of streaks in the innermost
constexpr int kSide = 24;          // streaks a side of a ring's square
constexpr int kSteps = 10;         // of a streak
constexpr double kCalmStreak = 0.7,
                 kStreak = 1.8;       // its length when calm, what 10 m/s add; in spacings
constexpr double kAbove_m = 0.35;     // over the ground: about the tips of the blades
constexpr double kFullScale_mps = 20; // the colour scale's end
constexpr double kPeriod_s = 1.4;     // from one pulse along a streak to the next

/// Calm to strong: blue, cyan, yellow, red; as bright as a screen in the sun needs.
ImU32 colour_of(double speed_mps, double alpha) {
    static constexpr std::array<glm::dvec3, 5> kScale = {
        {{0.25, 0.45, 1.0}, {0.2, 0.9, 1.0}, {1.0, 1.0, 0.45}, {1.0, 0.6, 0.1}, {1.0, 0.15, 0.1}}};
    const double at = std::clamp(speed_mps / kFullScale_mps, 0.0, 1.0) * (kScale.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
    const glm::dvec3 c = glm::mix(kScale[i], kScale[i + 1], at - static_cast<double>(i));
    return ImGui::ColorConvertFloat4ToU32({static_cast<float>(c.x), static_cast<float>(c.y),
                                           static_cast<float>(c.z), static_cast<float>(alpha)});
}

/// One streak: a path through the present land from `start` on, with pulses that run along it.
void draw_streak(ImDrawList& list, const Eye& eye, const Land& land, glm::dvec2 start,
                 double spacing_m, double phase) {
    glm::dvec2 at = start;
    const double first_mps = glm::length(land.wind(at.x, at.y));
    const double length_m = spacing_m * (kCalmStreak + kStreak * std::min(first_mps / 10, 2.0));
    std::optional<glm::dvec2> before;
    for (int step = 0; step <= kSteps; ++step) {
        const glm::dvec2 wind = land.wind(at.x, at.y);
        const double speed = glm::length(wind);
        const auto pixel = eye.pixel({at.x, land.height(at.x, at.y) + kAbove_m, at.y});
        if (before && pixel) {
            const double along = static_cast<double>(step) / kSteps, pulse = along - phase;
            const double alpha =
                std::min(1.0, 3 * std::min(along, 1.1 - along)) *
                (0.45 + 0.55 * std::pow(0.5 + 0.5 * std::cos(6.2832 * pulse), 3.0));
            list.AddLine({static_cast<float>(before->x), static_cast<float>(before->y)},
                         {static_cast<float>(pixel->x), static_cast<float>(pixel->y)},
                         colour_of(speed, alpha), 2.2f);
        }
        before = pixel;
        at += wind * (length_m / kSteps / std::max(speed, 1e-3));
    }
}

void draw_scale(ImDrawList& list) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    constexpr float kWidth = 180, kHeight = 10;
    const ImVec2 corner(size.x - kWidth - 24, size.y - 44);
    list.AddRectFilled({corner.x - 12, corner.y - 22}, {corner.x + kWidth + 12, corner.y + 34},
                       IM_COL32(10, 12, 14, 200), 4);
    list.AddText({corner.x, corner.y - 18}, IM_COL32_WHITE, "wind at the ground, m/s");
    constexpr int kPieces = 36;
    for (int i = 0; i < kPieces; ++i) {
        const float x = corner.x + kWidth * static_cast<float>(i) / kPieces;
        list.AddRectFilled({x, corner.y}, {x + kWidth / kPieces + 0.5f, corner.y + kHeight},
                           colour_of(kFullScale_mps * (i + 0.5) / kPieces, 1));
    }
    for (int mark = 0; mark <= 4; ++mark) {
        const std::string text = fmt::format("{:.0f}", kFullScale_mps * mark / 4);
        const float x = corner.x + kWidth * static_cast<float>(mark) / 4 -
                        ImGui::CalcTextSize(text.c_str()).x / 2;
        list.AddText({x, corner.y + kHeight + 3}, IM_COL32_WHITE, text.c_str());
    }
}

} // namespace

void draw_flow(const Eye& eye, const Land& land, double time_s) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const glm::dvec3 p = eye.position();
    // From high above nothing is near: the rings begin where a spacing is some pixels wide.
    const double high = std::max(p.y - land.height(p.x, p.z), 1.0);
    const double first = kSpacing_m * std::exp2(std::max(0.0, std::floor(std::log2(high / 12))));
    for (int ring = 0; ring < kRings; ++ring) {
        const double spacing = first * std::exp2(ring);
        const glm::ivec2 middle(glm::round(glm::dvec2(p.x, p.z) / spacing));
        for (int z = -kSide / 2; z < kSide / 2; ++z)
            for (int x = -kSide / 2; x < kSide / 2; ++x) {
                const bool inner =
                    x >= -kSide / 4 && x < kSide / 4 && z >= -kSide / 4 && z < kSide / 4;
                if (ring > 0 && inner)
                    continue;
                // Places belong to the world: streaks stay put when the eye moves.
                const glm::ivec2 cell = middle + glm::ivec2(x, z);
                const auto random = [&](std::uint64_t n) {
                    return base::hash_unit(static_cast<std::uint64_t>(ring) * 8 + n,
                                           static_cast<std::uint64_t>(cell.x + 0x40000000),
                                           static_cast<std::uint64_t>(cell.y + 0x40000000));
                };
                const glm::dvec2 start =
                    (glm::dvec2(cell) + glm::dvec2(random(0), random(1))) * spacing;
                const glm::dvec3 world(start.x, land.height(start.x, start.y) + kAbove_m, start.y);
                if (!eye.pixel(world))
                    continue;
                draw_streak(list, eye, land, start, spacing, time_s / kPeriod_s + random(2));
            }
    }
    draw_scale(list);
}

} // namespace sward::app
