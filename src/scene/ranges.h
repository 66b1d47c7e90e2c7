// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::scene {

/// What a number in a scene file or pose may be. docs/scene.md lists them all.
struct Range {
    double low, high;
    const char* unit; ///< for messages; "" for a bare number
};

/// Values drawn evenly between two ends, both included.
struct Span {
    double low = 0;
    double high = 0;

    [[nodiscard]] double mean() const { return 0.5 * (low + high); }
    bool operator==(const Span&) const = default;
};

inline constexpr Range kPlace{
    -1e6, 1e6, "m"}; // from the terrain's centre; float32 on the GPU keeps 6 cm there
inline constexpr Range kLatitude{-90, 90, "degrees"};
inline constexpr Range kLongitude{-180, 360, "degrees"};
inline constexpr Range kHeight{-2e4, 1e5, "m"};
inline constexpr Range kYaw{-360, 360, "degrees"};
inline constexpr Range kPitch{-90, 90, "degrees"};
inline constexpr Range kFov{1, 170, "degrees"};
inline constexpr Range kTime{0, 1e6, "s"};
inline constexpr Range kLength{0.01, 1e5, "m"};
inline constexpr Range kShare{0, 1, ""};

} // namespace sward::scene
