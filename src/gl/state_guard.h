// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace sward::gl {

/// The host's OpenGL state while Sward works: saved, and set to what the passes take for granted
/// (the defaults of a fresh context), by the constructor; put back by the destructor. It holds all
/// that the passes touch; docs/architecture.md lists what it cannot hold. Costs some 300 questions
/// to the driver, which wait for nothing on the GPU.
class StateGuard {
public:
    StateGuard();
    ~StateGuard();
    StateGuard(const StateGuard&) = delete;
    StateGuard& operator=(const StateGuard&) = delete;

    static constexpr int kUnits = 34;         ///< texture units 0 to 33
    static constexpr int kUniformBuffers = 7; ///< bindings
    static constexpr int kStorageBuffers = 8;
    static constexpr int kDrawBuffers = 8; ///< with a colour mask and blending of their own
    static constexpr int kCaps = 28;       ///< switches
    static constexpr int kPixelStores = 24;

private:
    struct Range {
        int buffer = 0;
        std::int64_t first = 0, size = 0;
    };
    void save_switches();
    void save_bindings();
    void restore_switches() const;
    void restore_bindings() const;

    std::array<bool, kCaps> caps_{};
    std::array<bool, kDrawBuffers> blends_{};
    std::array<std::array<unsigned char, 4>, kDrawBuffers> colour_masks_{};
    std::array<int, 6> blend_{}; ///< of draw buffer 0: functions, equations
    std::array<int, kPixelStores> pixel_stores_{};
    std::array<int, 2> polygon_mode_{};
    std::array<float, 4> viewport_{};
    std::array<double, 2> depth_range_{};
    bool scissor_ = false, depth_mask_ = true;
    int cull_face_ = 0, front_face_ = 0, depth_func_ = 0, clip_origin_ = 0, clip_depth_ = 0,
        provoking_ = 0, patch_vertices_ = 0;
    int program_ = 0, vertex_array_ = 0, draw_framebuffer_ = 0, read_framebuffer_ = 0,
        active_unit_ = 0;
    std::array<int, 7> buffers_{}; ///< bound to a target as a whole
    std::array<Range, kUniformBuffers> uniform_{};
    std::array<Range, kStorageBuffers> storage_{};
    std::array<std::array<int, 4>, kUnits> textures_{};
    std::array<int, kUnits> samplers_{};
    std::array<int, 6> image_{}; ///< of image unit 0
};

} // namespace sward::gl
