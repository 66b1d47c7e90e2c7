// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace sward::gl {

/// What a program does between the parts of long work: before each pass, and before each shader
/// program is built. It hears the window's events, say. It must leave the context's state as it is,
/// and may throw, which ends the picture. Empty: nothing. Of the whole process, on the context's
/// thread.
void set_breath(std::function<void()> breath);
/// For passes and programs.
void breathe();

/// A breath from construction to destruction.
class BreathScope {
public:
    explicit BreathScope(std::function<void()> breath) { set_breath(std::move(breath)); }
    ~BreathScope() { set_breath({}); }
    BreathScope(const BreathScope&) = delete;
    BreathScope& operator=(const BreathScope&) = delete;
};

} // namespace sward::gl
