// SPDX-License-Identifier: Apache-2.0
#include "tracks/print_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sward::tracks {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kFarthest_m = 1e7;   // of what is looked at
constexpr double kMostReach_m = 1000; // of a print: what is larger is cut to it

bool finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Stand {
    glm::dvec2 place{0};
    glm::vec2 turn{1, 0};
    double height_m = 0; ///< of the path over the ground
};

Stand stand_of(const scene::TrackFoot& foot, const scene::Path& path, double time_s,
               const Ground& ground) {
    const scene::Pose pose = scene::sample_path(path, time_s);
    const double yaw = pose.yaw_deg * kDegree;
    const glm::dvec2 right(std::cos(yaw), std::sin(yaw)), back(-std::sin(yaw), std::cos(yaw));
    Stand out;
    out.place =
        glm::dvec2(pose.position.x, pose.position.z) + right * foot.place.x + back * foot.place.y;
    out.turn = glm::vec2(right);
    out.height_m = pose.agl ? pose.position.y : pose.position.y - ground(out.place.x, out.place.y);
    return out;
}

} // namespace

shared::TrackPrint Print::from(glm::dvec2 corner) const {
    shared::TrackPrint out{};
    out.now = {glm::vec2(now - corner), turn_now};
    out.before = {glm::vec2(before - corner), turn_before};
    out.half_width_m = shape.x;
    out.half_depth_m = shape.y;
    out.underside_m = shape.z;
    out.load = shape.w;
    out.kind = kind;
    return out;
}

PrintList::PrintList(const scene::TrackSpec& spec, std::map<std::string, scene::Path> paths,
                     double canopy_m, Ground ground)
    : spec_(spec), paths_(std::move(paths)), canopy_m_(canopy_m), ground_(std::move(ground)) {}

void PrintList::add(std::vector<Print>& out, Print print) const {
    print.shape.z = std::max(print.shape.z, 0.0f);
    const double away = std::max({std::abs(print.now.x), std::abs(print.now.y),
                                  std::abs(print.before.x), std::abs(print.before.y)});
    if (!(static_cast<double>(print.shape.z) < canopy_m_) || !(away < kFarthest_m)) {
        return;
    }
    if (glm::distance(print.now, print.before) > kMostSweep_m) {
        ++leaps_;
        print.before = print.now;
        print.turn_before = print.turn_now;
    }
    print.shape.x = std::min(print.shape.x, static_cast<float>(kMostReach_m));
    print.shape.y = std::min(print.shape.y, static_cast<float>(kMostReach_m));
    const double reach = (print.kind == shared::kPrintSphere
                              ? static_cast<double>(print.shape.y)
                              : glm::length(glm::dvec2(print.shape.x, print.shape.y))) +
                         2 * spec_.cell_m;
    print.low = glm::min(print.now, print.before) - reach;
    print.high = glm::max(print.now, print.before) + reach;
    out.push_back(print);
}

std::vector<Print> PrintList::at(double time_s, double step_s, std::span<const Ball> balls) const {
    std::vector<Print> out;
    for (const scene::TrackFoot& foot : spec_.feet) {
        const scene::Path& path = paths_.at(foot.path);
        const Stand now = stand_of(foot, path, time_s, ground_),
                    before = stand_of(foot, path, time_s - step_s, ground_);
        Print print;
        print.now = now.place;
        print.before = before.place;
        print.turn_now = now.turn;
        print.turn_before = before.turn;
        const bool box = foot.kind == scene::TrackFoot::Kind::kBox;
        print.kind = box ? shared::kPrintBox : shared::kPrintWheel;
        print.shape = glm::vec4(glm::dvec4(0.5 * foot.size.x, box ? 0.5 * foot.size.y : foot.size.y,
                                           foot.height_m + std::min(now.height_m, before.height_m),
                                           foot.load));
        add(out, print);
    }
    for (const Ball& ball : balls) {
        if (!finite(ball.centre) || !finite(ball.before) || !(ball.radius_m > 0)) {
            continue;
        }
        const double under = std::min(ball.centre.y - ground_(ball.centre.x, ball.centre.z),
                                      ball.before.y - ground_(ball.before.x, ball.before.z));
        Print print;
        print.now = {ball.centre.x, ball.centre.z};
        print.before = {ball.before.x, ball.before.z};
        print.kind = shared::kPrintSphere;
        print.shape = glm::vec4(glm::dvec4(ball.radius_m, ball.radius_m, under - ball.radius_m, 1));
        add(out, print);
    }
    return out;
}

} // namespace sward::tracks
