// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace sward::gl {

/// What the current context is. Needs a current context.
struct ContextInfo {
    std::string vendor, renderer, version, glsl_version;
    int max_samples = 0;
    int max_texture_size = 0;
    int max_array_layers = 0;
    long long max_storage_bytes = 0; ///< of one shader storage block
};
[[nodiscard]] ContextInfo context_info();

/// An EGL context without a window: the first hardware EGL device that gives OpenGL 4.5 core, else
/// Mesa's surfaceless platform (software). Current on this thread from construction to destruction.
/// Throws Error(kNoGpu) that says what was tried.
class HeadlessContext {
public:
    explicit HeadlessContext(bool debug = false);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;
    [[nodiscard]] const std::string& platform() const; ///< "surfaceless" or "device N"

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Throws Error(kNoGpu) unless the current context is OpenGL 4.5 core or later.
void require_gl45();

/// Counts debug messages of severity medium and above from now on; the text of the first is kept.
/// Tests fail on any.
struct DebugMessages {
    int count = 0;
    std::string first;
};
void watch_debug_messages(DebugMessages* sink);

} // namespace sward::gl
