// SPDX-License-Identifier: Apache-2.0
#include "app/arrow_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/error.h"
#include "base/log.h"
#include "scene/arrow_text.h"
#include "wind/arrow_times.h"

namespace sward::app {
namespace {

using scene::ArrowEnd;
using scene::ArrowHandle;

constexpr double kReach_m = 2000; // of a click
constexpr double kGrab_px = 12;   // around a point
constexpr double kAbove_m = 0.4;  // arrows float over the grass
constexpr int kPieces = 12;       // of a shaft, so that it follows the ground
constexpr int kCirclePieces = 48;
constexpr ImU32 kOutline = IM_COL32(0, 0, 0, 150), kIdle = IM_COL32(190, 200, 210, 255),
                kBlowing = IM_COL32(255, 205, 60, 255), kSelected = IM_COL32(255, 120, 40, 255),
                kPending = IM_COL32(120, 255, 140, 255);

glm::dvec3 lifted(const Land& land, glm::dvec2 at) {
    return {at.x, land.height(at.x, at.y) + kAbove_m, at.y};
}

ImVec2 as_im(glm::dvec2 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

/// A line over the ground from point to point, with a dark rim that shows on grass and sky alike.
void draw_path(ImDrawList& list, const Eye& eye, const std::vector<glm::dvec3>& points,
               ImU32 colour, float width) {
    for (const auto& [ink, wide] : {std::pair(kOutline, width + 2.5f), std::pair(colour, width)}) {
        std::optional<glm::dvec2> before;
        for (const glm::dvec3& point : points) {
            const auto pixel = eye.pixel(point);
            if (before && pixel)
                list.AddLine(as_im(*before), as_im(*pixel), ink, wide);
            before = pixel;
        }
    }
}

void draw_shaft(ImDrawList& list, const Eye& eye, const Land& land, const scene::WindArrow& arrow,
                ImU32 colour) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= kPieces; ++i)
        points.push_back(
            lifted(land, glm::mix(arrow.root, arrow.tip, static_cast<double>(i) / kPieces)));
    draw_path(list, eye, points, colour, 3);
    // The head lies on the ground too; its size is the arrow's, but never more than a few metres.
    const glm::dvec2 along = glm::normalize(arrow.tip - arrow.root), across(-along.y, along.x);
    const double size = std::min(0.25 * glm::distance(arrow.root, arrow.tip), 2.5);
    draw_path(list, eye,
              {lifted(land, arrow.tip - (along + across * 0.5) * size), lifted(land, arrow.tip),
               lifted(land, arrow.tip - (along - across * 0.5) * size)},
              colour, 3);
}

void draw_circle(ImDrawList& list, const Eye& eye, const Land& land, const scene::WindArrow& arrow,
                 ImU32 colour) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= kCirclePieces; ++i) {
        const double angle = 6.283185307 * i / kCirclePieces;
        points.push_back(lifted(land, arrow.tip + glm::dvec2(std::cos(angle), std::sin(angle)) *
                                                      arrow.radius_m));
    }
    draw_path(list, eye, points, (colour & 0x00ffffffU) | 0x90000000U, 1.5f);
}

void draw_point(ImDrawList& list, const Eye& eye, const Land& land, glm::dvec2 at, ImU32 colour,
                float radius) {
    if (const auto pixel = eye.pixel(lifted(land, at))) {
        list.AddCircleFilled(as_im(*pixel), radius + 1.5f, kOutline);
        list.AddCircleFilled(as_im(*pixel), radius, colour);
    }
}

/// Slider and number for one value; changes of one drag are one step to undo.
bool edit_number(scene::ArrowEdit& edit, const char* label, double& value, double least,
                 double most, const char* format) {
    ImGui::PushID(label);
    ImGui::SetNextItemWidth(130);
    bool changed =
        ImGui::SliderScalar("##slider", ImGuiDataType_Double, &value, &least, &most, format,
                            ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActivated())
        edit.begin();
    if (ImGui::IsItemDeactivated())
        edit.end();
    ImGui::SameLine();
    ImGui::SetNextItemWidth(70);
    changed =
        ImGui::InputDouble(label, &value, 0, 0, format, ImGuiInputTextFlags_EnterReturnsTrue) ||
        changed;
    ImGui::PopID();
    return changed;
}

} // namespace

bool ArrowPanel::draw(const Eye& eye, const Land& land, double time_s) {
    if (!shown) {
        root_.reset();
        dragged_.reset();
        edit_.end();
        return false;
    }
    take_mouse(eye, land);
    draw_inspector(time_s);
    forget_what_is_gone();
    draw_arrows(eye, land, time_s);
    const bool changed = told_ != edit_.arrows();
    told_ = edit_.arrows();
    return changed;
}

void ArrowPanel::forget_what_is_gone() {
    if (selected_ && selected_->arrow >= edit_.arrows().size())
        selected_.reset();
    if (hovered_ && hovered_->arrow >= edit_.arrows().size())
        hovered_.reset();
    if (dragged_ && dragged_->arrow >= edit_.arrows().size())
        dragged_.reset();
}

std::optional<ArrowHandle> ArrowPanel::under_mouse(const Eye& eye, const Land& land) const {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<ArrowHandle> best;
    double least = kGrab_px;
    for (const ArrowEnd end : {ArrowEnd::kTip, ArrowEnd::kRoot})
        for (std::size_t i = 0; i < edit_.arrows().size(); ++i) {
            const ArrowHandle handle{i, end};
            const auto pixel = eye.pixel(lifted(land, edit_.place(handle)));
            if (!pixel)
                continue;
            const double away = glm::distance(*pixel, glm::dvec2(mouse.x, mouse.y));
            if (away < least)
                best = handle, least = away;
        }
    return best;
}

void ArrowPanel::take_mouse(const Eye& eye, const Land& land) {
    const ImGuiIO& io = ImGui::GetIO();
    cursor_.reset();
    if (const auto ground = eye.ground_under({io.MousePos.x, io.MousePos.y}, land.height, kReach_m))
        cursor_ = glm::dvec2(ground->x, ground->z);
    hovered_ = io.WantCaptureMouse ? std::nullopt : under_mouse(eye, land);
    if (!io.WantCaptureMouse && cursor_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        press(*cursor_, hovered_);
    if (!dragged_)
        return;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        if (cursor_ && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3))
            edit_.move(*dragged_, *cursor_);
    } else {
        dragged_.reset();
        edit_.end();
    }
}

void ArrowPanel::press(glm::dvec2 ground, std::optional<ArrowHandle> under) {
    if (under) {
        selected_ = dragged_ = under;
        root_.reset();
        edit_.begin();
        return;
    }
    std::optional<std::size_t> made;
    if (ImGui::GetIO().KeyShift && selected_)
        made = edit_.branch(selected_->arrow, ground);
    else if (root_)
        made = edit_.add(*root_, ground);
    else {
        root_ = ground;
        selected_.reset();
        return;
    }
    message_ = made ? "" : "too short, or too many arrows";
    if (made) {
        root_.reset();
        selected_ = ArrowHandle{*made, ArrowEnd::kTip};
    }
}

void ArrowPanel::act(const Input& input) {
    if (!shown)
        return;
    if (input.has(Action::kDelete))
        erase_selected(input.fast);
    if (input.has(Action::kUndo))
        edit_.undo();
    if (input.has(Action::kRedo))
        edit_.redo();
    if (input.has(Action::kSave))
        save();
    forget_what_is_gone();
}

void ArrowPanel::erase_selected(bool branch) {
    if (!selected_)
        return;
    if (branch)
        edit_.erase_branch(selected_->arrow);
    else
        edit_.erase(selected_->arrow);
    selected_.reset();
    hovered_.reset();
    dragged_.reset();
}

void ArrowPanel::save() {
    try {
        scene::save_arrows(file_, edit_.arrows());
        edit_.set_saved();
        message_ = fmt::format("saved {} arrows", edit_.arrows().size());
        base::log_info(fmt::format("{}: {}", base::printable(file_.native()), message_));
    } catch (const base::Error& error) { // a full disk costs nothing but this
        message_ = error.what();
        base::log_error(message_);
    }
}

void ArrowPanel::draw_arrows(const Eye& eye, const Land& land, double time_s) const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto spans = wind::arrow_spans(edit_.arrows());
    for (std::size_t i = 0; i < edit_.arrows().size(); ++i) {
        const scene::WindArrow& arrow = edit_.arrows()[i];
        const bool blowing = time_s >= spans[i].start_s && time_s < spans[i].end_s;
        const ImU32 colour = selected_ && selected_->arrow == i ? kSelected
                             : blowing                          ? kBlowing
                                                                : kIdle;
        draw_circle(list, eye, land, arrow, colour);
        draw_shaft(list, eye, land, arrow, colour);
    }
    for (std::size_t i = 0; i < edit_.arrows().size(); ++i)
        for (const ArrowEnd end : {ArrowEnd::kRoot, ArrowEnd::kTip}) {
            const ArrowHandle handle{i, end};
            const bool hot = hovered_ == handle, chosen = selected_ == handle;
            draw_point(list, eye, land, edit_.place(handle),
                       chosen ? kSelected
                       : hot  ? IM_COL32_WHITE
                              : kIdle,
                       hot || chosen ? 7.0f : 4.5f);
        }
    if (root_) {
        if (cursor_ && glm::distance(*root_, *cursor_) >= scene::ArrowEdit::kLeastLength_m) {
            scene::WindArrow sketch;
            sketch.root = *root_;
            sketch.tip = *cursor_;
            draw_shaft(list, eye, land, sketch, kPending);
        }
        draw_point(list, eye, land, *root_, kPending, 6);
    }
}

void ArrowPanel::draw_selected() {
    const std::size_t at = selected_->arrow;
    const scene::WindArrow& arrow = edit_.arrows()[at];
    ImGui::Text("%s%s%s", arrow.id.c_str(), arrow.parent.empty() ? "" : "  continues ",
                arrow.parent.c_str());
    ImGui::TextDisabled("root %.2f, %.2f   tip %.2f, %.2f   %.2f m", arrow.root.x, arrow.root.y,
                        arrow.tip.x, arrow.tip.y, glm::distance(arrow.root, arrow.tip));
    double strength = arrow.strength_mps, radius = arrow.radius_m;
    if (edit_number(edit_, "strength, m/s", strength, 0.0, 60.0, "%.2f"))
        edit_.set_strength(at, strength);
    if (edit_number(edit_, "radius, m", radius, 0.1, 100.0, "%.2f"))
        edit_.set_radius(at, radius);
    const wind::Span span = wind::arrow_spans(edit_.arrows())[at];
    if (std::isfinite(span.start_s))
        ImGui::Text("blows from %.2f s%s", span.start_s,
                    std::isfinite(span.end_s) ? fmt::format(" to {:.2f} s", span.end_s).c_str()
                                              : "");
    else
        ImGui::TextUnformatted("never blows: an arrow before it has no strength");
    if (ImGui::Button("delete"))
        erase_selected(false);
    ImGui::SameLine();
    if (ImGui::Button("delete with all that continues it"))
        erase_selected(true);
}

void ArrowPanel::draw_inspector(double time_s) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - 10, 10}, ImGuiCond_FirstUseEver, {1, 0});
    if (ImGui::Begin("Arrows", &shown, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::Text("%d arrows%s, t %.1f s", static_cast<int>(edit_.arrows().size()),
                    edit_.unsaved() ? ", not saved" : "", time_s);
        ImGui::Separator();
        if (selected_ && selected_->arrow < edit_.arrows().size())
            draw_selected();
        else if (root_)
            ImGui::TextUnformatted("click where its tip is");
        else
            ImGui::TextUnformatted("click a point, or the ground for a root");
        ImGui::Separator();
        if (ImGui::Button("undo") && edit_.can_undo())
            edit_.undo();
        ImGui::SameLine();
        if (ImGui::Button("redo") && edit_.can_redo())
            edit_.redo();
        ImGui::SameLine();
        if (ImGui::Button("save"))
            save();
        ImGui::TextDisabled("drag moves a point, shift + click continues the");
        ImGui::TextDisabled("selected arrow; Del, Shift+Del; Ctrl+Z, Y, S");
        if (!message_.empty()) {
            ImGui::PushTextWrapPos(330);
            ImGui::TextUnformatted(message_.c_str());
            ImGui::PopTextWrapPos();
        }
    }
    ImGui::End();
}

} // namespace sward::app
