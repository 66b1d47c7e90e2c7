// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sward/camera.h"
#include "sward/field.h"

namespace sward {

/// Where a picture goes, and what of the host's own is in it. Textures are single-sampled
/// GL_TEXTURE_2D of the picture's size; 0: none.
struct Target {
    int width = 0, height = 0; ///< pixels; at least 1, at most what the GPU's textures take

    /// Out: the picture for a display, 8-bit sRGB, copied to `x`, `y` (its bottom left) of this
    /// framebuffer; 0 is the window's.
    std::optional<std::uint32_t> framebuffer = {};
    int x = 0, y = 0;
    /// Out: linear radiance of the scene before exposure, alpha 1 (GL_RGBA16F or 32F).
    std::uint32_t colour = 0;
    /// Out: depth as Camera::clip_from_view has it (GL_DEPTH_COMPONENT24 or 32F); where there is
    /// only sky, what a host clears to: 0 for reversed depth, 1 else.
    std::uint32_t depth = 0;
    /// In: what the host has drawn so far, depth likewise (compare mode off), and its linear
    /// radiance: it hides grass, stands in it, and shows where nothing is before it. May be
    /// `colour` and `depth` themselves. A depth as in an empty place is nothing.
    std::uint32_t scene_colour = 0, scene_depth = 0;
};

struct Quality {
    int samples = 4;    ///< a pixel: 1, 2 or 4; memory and fill grow with it
    float exposure = 1; ///< of the display picture; above 0
};

namespace render {
struct ViewInside;
} // namespace render

/// The eye's place that a camera stands for: what Field::simulate() takes. Throws Error(kBadInput)
/// for a matrix that is none of a camera's.
[[nodiscard]] glm::dvec3 eye_of(const Camera& camera);

/// One picture of a field, frame after frame: a window, a channel, an eye of two, a mirror. Views
/// of a field share its simulation and its textures and have targets of their own; the order in
/// which they draw changes no pixel. Context, state and errors are as Field's.
class View {
public:
    /// Makes the field ready if it is not. The field's insides live on as long as a view of it
    /// does.
    explicit View(Field& field);
    ~View();
    View(View&&) noexcept;
    View& operator=(View&&) noexcept;

    /// From the next draw() on.
    void set_quality(const Quality& quality);
    /// Draws the field as it now is: one simulate() before, then any number of views. Throws Error:
    /// kBadInput for a camera or textures that cannot be used, kOverLimit for a size or samples
    /// over the GPU's limit, kNoGpu for shader and memory trouble.
    void draw(const Camera& camera, const Target& target);

    /// The display picture just drawn: sRGB bytes r, g, b, row by row from the top. Waits for the
    /// GPU.
    [[nodiscard]] std::vector<std::uint8_t> read_picture() const;

private:
    friend struct render::Access;
    std::unique_ptr<render::ViewInside> inside_;
};

} // namespace sward
