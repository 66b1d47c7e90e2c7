// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/eye.h"
#include "app/flow_overlay.h"
#include "app/window.h"
#include "scene/arrow_edit.h"

namespace sward::app {

/// The arrow editor of the viewer: ImGui and the mouse around scene::ArrowEdit. A click on the
/// ground sets a root, the next its tip; shift and a click continue the selected arrow; a drag
/// moves a point.
class ArrowPanel {
public:
    /// `file` is where it saves to.
    ArrowPanel(std::vector<scene::WindArrow> arrows, std::filesystem::path file)
        : edit_(std::move(arrows)), told_(edit_.arrows()), file_(std::move(file)) {}

    /// What keys ask for, while it is shown.
    void act(const Input& input);
    /// Draws arrows and inspector and takes the mouse, within an ImGui frame. Returns whether the
    /// arrows have changed since it last said so.
    bool draw(const Eye& eye, const Land& land, double time_s);
    [[nodiscard]] const std::vector<scene::WindArrow>& arrows() const { return edit_.arrows(); }

    bool shown = false;

private:
    void take_mouse(const Eye& eye, const Land& land);
    void press(glm::dvec2 ground, std::optional<scene::ArrowHandle> under);
    void draw_arrows(const Eye& eye, const Land& land, double time_s) const;
    void draw_inspector(double time_s);
    void draw_selected();
    void erase_selected(bool branch);
    void forget_what_is_gone();
    void save();
    [[nodiscard]] std::optional<scene::ArrowHandle> under_mouse(const Eye& eye,
                                                                const Land& land) const;

    scene::ArrowEdit edit_;
    std::vector<scene::WindArrow> told_; ///< what draw() last announced
    std::filesystem::path file_;
    std::optional<scene::ArrowHandle> selected_, dragged_, hovered_;
    std::optional<glm::dvec2> root_;   ///< set, waits for its tip
    std::optional<glm::dvec2> cursor_; ///< where the mouse is on the ground
    std::string message_;
};

} // namespace sward::app
