// SPDX-License-Identifier: Apache-2.0
#include "scene/arrow_edit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sward::scene {
namespace {

constexpr double kNewStrength_mps = 8, kNewRadius_m = 3;
constexpr double kMostStrength_mps = 300, kLeastRadius_m = 0.01,
                 kMostRadius_m = 1000; // wind_section.cpp's ranges
constexpr double kMostPlace_m = 1e6;

/// On whole millimetres: a file stays readable, and equal places stay equal.
glm::dvec2 tidy(glm::dvec2 at) {
    return glm::clamp(glm::round(at * 1000.0) / 1000.0, glm::dvec2(-kMostPlace_m),
                      glm::dvec2(kMostPlace_m));
}

bool finite(glm::dvec2 at) {
    return std::isfinite(at.x) && std::isfinite(at.y);
}

bool long_enough(const WindArrow& arrow) {
    return glm::distance(arrow.root, arrow.tip) >= ArrowEdit::kLeastLength_m;
}

/// Arrows whose ancestors include one of `gone` (by id) are erased too.
void erase_with_children(std::vector<WindArrow>& arrows, std::vector<std::string> gone) {
    while (!gone.empty()) {
        std::vector<std::string> next;
        std::erase_if(arrows, [&](const WindArrow& arrow) {
            const auto among = [&](const std::string& id) {
                return std::find(gone.begin(), gone.end(), id) != gone.end();
            };
            if (!among(arrow.id) && !among(arrow.parent))
                return false;
            if (!among(arrow.id))
                next.push_back(arrow.id);
            return true;
        });
        gone = std::move(next);
    }
}

} // namespace

glm::dvec2 ArrowEdit::place(ArrowHandle handle) const {
    const WindArrow& arrow = arrows_.at(handle.arrow);
    return handle.end == ArrowEnd::kRoot ? arrow.root : arrow.tip;
}

std::optional<ArrowHandle> ArrowEdit::nearest(glm::dvec2 at, double reach_m) const {
    std::optional<ArrowHandle> best;
    double least = reach_m;
    for (const ArrowEnd end :
         {ArrowEnd::kTip, ArrowEnd::kRoot}) // tips first: a root on one is no nearer
        for (std::size_t i = 0; i < arrows_.size(); ++i)
            if (const double away = glm::distance(place({i, end}), at); away < least)
                best = ArrowHandle{i, end}, least = away;
    return best;
}

std::optional<std::size_t> ArrowEdit::add(glm::dvec2 root, glm::dvec2 tip) {
    WindArrow arrow;
    arrow.root = root;
    arrow.tip = tip;
    arrow.strength_mps = kNewStrength_mps;
    arrow.radius_m = kNewRadius_m;
    return append(arrow);
}

std::optional<std::size_t> ArrowEdit::branch(std::size_t parent, glm::dvec2 tip) {
    const WindArrow& trunk = arrows_.at(parent);
    WindArrow arrow;
    arrow.parent = trunk.id;
    arrow.root = trunk.tip;
    arrow.tip = tip;
    arrow.strength_mps = trunk.strength_mps;
    arrow.radius_m = trunk.radius_m;
    return append(arrow);
}

std::optional<std::size_t> ArrowEdit::append(WindArrow arrow) {
    if (arrows_.size() >= kMostArrows || !finite(arrow.root) || !finite(arrow.tip))
        return std::nullopt;
    if (arrow.parent.empty()) // a parent's tip stays as the file has it
        arrow.root = tidy(arrow.root);
    arrow.tip = tidy(arrow.tip);
    if (!long_enough(arrow))
        return std::nullopt;
    arrow.id = free_id();
    State next = arrows_;
    next.push_back(std::move(arrow));
    commit(std::move(next));
    return arrows_.size() - 1;
}

bool ArrowEdit::move(ArrowHandle handle, glm::dvec2 to) {
    if (!finite(to))
        return false;
    const WindArrow& arrow = arrows_.at(handle.arrow);
    if (handle.end == ArrowEnd::kRoot && !arrow.parent.empty())
        if (const std::size_t parent = index_of(arrow.parent); arrows_[parent].tip == arrow.root)
            return move({parent, ArrowEnd::kTip}, to);
    State next = arrows_;
    WindArrow& moved = next[handle.arrow];
    const glm::dvec2 from = place(handle);
    to = tidy(to);
    (handle.end == ArrowEnd::kRoot ? moved.root : moved.tip) = to;
    bool fine = long_enough(moved);
    if (handle.end == ArrowEnd::kTip)
        for (WindArrow& child : next)
            if (child.parent == moved.id && child.root == from) {
                child.root = to;
                fine = fine && long_enough(child);
            }
    if (fine)
        commit(std::move(next));
    return fine;
}

void ArrowEdit::erase(std::size_t arrow) {
    const WindArrow gone = arrows_.at(arrow);
    State next = arrows_;
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(arrow));
    std::vector<std::string> too_short;
    for (WindArrow& child : next) {
        if (child.parent != gone.id)
            continue;
        child.parent = gone.parent;
        if (child.root == gone.tip)
            child.root = gone.root;
        if (!long_enough(child))
            too_short.push_back(child.id);
    }
    erase_with_children(next, std::move(too_short));
    commit(std::move(next));
}

void ArrowEdit::erase_branch(std::size_t arrow) {
    State next = arrows_;
    erase_with_children(next, {arrows_.at(arrow).id});
    commit(std::move(next));
}

void ArrowEdit::set_strength(std::size_t arrow, double strength_mps) {
    if (!std::isfinite(strength_mps))
        return;
    State next = arrows_;
    next.at(arrow).strength_mps = std::clamp(strength_mps, 0.0, kMostStrength_mps);
    commit(std::move(next));
}

void ArrowEdit::set_radius(std::size_t arrow, double radius_m) {
    if (!std::isfinite(radius_m))
        return;
    State next = arrows_;
    next.at(arrow).radius_m = std::clamp(radius_m, kLeastRadius_m, kMostRadius_m);
    commit(std::move(next));
}

void ArrowEdit::begin() {
    if (open_ == Open::kNo)
        open_ = Open::kFresh;
}

void ArrowEdit::commit(State next) {
    if (next == arrows_)
        return;
    if (open_ != Open::kChanged) { // within a drag only its first step counts
        before_.push_back(arrows_);
        if (before_.size() > kMostUndo)
            before_.erase(before_.begin());
    }
    if (open_ == Open::kFresh)
        open_ = Open::kChanged;
    after_.clear();
    arrows_ = std::move(next);
}

bool ArrowEdit::undo() {
    end();
    if (before_.empty())
        return false;
    after_.push_back(std::move(arrows_));
    arrows_ = std::move(before_.back());
    before_.pop_back();
    return true;
}

bool ArrowEdit::redo() {
    end();
    if (after_.empty())
        return false;
    before_.push_back(std::move(arrows_));
    arrows_ = std::move(after_.back());
    after_.pop_back();
    return true;
}

std::size_t ArrowEdit::index_of(const std::string& id) const {
    const auto found = std::find_if(arrows_.begin(), arrows_.end(),
                                    [&](const WindArrow& a) { return a.id == id; });
    return static_cast<std::size_t>(found - arrows_.begin());
}

std::string ArrowEdit::free_id() const {
    for (std::size_t number = arrows_.size() + 1;; ++number) {
        std::string id = fmt::format("arrow-{}", number);
        if (index_of(id) == arrows_.size())
            return id;
    }
}

} // namespace sward::scene
