// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/program.h"
#include "render/targets.h"

namespace sward::render {

/// Passes that cover the screen with one triangle: sky, resolve, tone map.
class ScreenPasses {
public:
    explicit ScreenPasses(bool aov);
    ~ScreenPasses();
    ScreenPasses(const ScreenPasses&) = delete;
    ScreenPasses& operator=(const ScreenPasses&) = delete;

    /// Fills what nothing covered. The scene targets are bound.
    void sky();
    /// Averages samples into the resolved targets, weighted; `first` replaces what they hold, later frames add to it.
    void resolve(const Targets& targets, float weight, bool first);
    /// Resolved radiance to the 8-bit picture.
    void tone_map(const Targets& targets, float exposure);
    void reload();

private:
    void triangle() const;
    gl::Program sky_, resolve_, tone_map_;
    std::uint32_t vertex_array_ = 0;
};

} // namespace sward::render
