// SPDX-License-Identifier: Apache-2.0
#include "tracks/print_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"

namespace sward::tracks {

namespace {

constexpr double kFarthest_m = 1e7; // of what is looked at

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
    const base::Heading heading(pose.yaw_deg);
    Stand out;
    out.place = glm::dvec2(pose.position.x, pose.position.z) + heading.right() * foot.place.x +
                heading.back() * foot.place.y;
    out.turn = glm::vec2(heading.right());
    out.height_m = pose.agl ? pose.position.y : pose.position.y - ground(out.place.x, out.place.y);
    return out;
}

/// Cosine and sine of the yaw of a frame.
glm::vec2 heading_of(const glm::dmat4& frame) {
    const glm::dvec2 right(frame[0].x, frame[0].z);
    const double length = glm::length(right);
    return length > 1e-6 ? glm::vec2(right / length) : glm::vec2(1, 0);
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
    out.map = map;
    out.tilt = tilt;
    return out;
}

PrintList::PrintList(const scene::TrackSpec& spec, std::map<std::string, scene::Path> paths,
                     double canopy_m, Ground ground)
    : spec_(spec), paths_(std::move(paths)), canopy_m_(canopy_m), ground_(std::move(ground)) {}

void PrintList::set_meshes(std::span<const scene::Mesh* const> meshes) {
    undersides_.clear();
    for (const scene::Mesh* mesh : meshes) {
        undersides_.push_back(underside_of(*mesh, spec_.cell_m, canopy_m_, kMostReach_m));
    }
    maps_ = joined(undersides_);
}

void PrintList::add(std::vector<Print>& out, Print print, double reach_m) const {
    const double away = std::max({std::abs(print.now.x), std::abs(print.now.y),
                                  std::abs(print.before.x), std::abs(print.before.y)});
    if (!(away < kFarthest_m)) {
        return;
    }
    if (glm::distance(print.now, print.before) > kMostSweep_m) {
        ++leaps_;
        print.before = print.now;
        print.turn_before = print.turn_now;
    }
    const double reach = std::min(reach_m, 2 * kMostReach_m) + 2 * spec_.cell_m;
    print.low = glm::min(print.now, print.before) - reach;
    print.high = glm::max(print.now, print.before) + reach;
    out.push_back(print);
}

void PrintList::add_shape(std::vector<Print>& out, Print print) const {
    print.shape.z = std::max(print.shape.z, 0.0f);
    if (!(static_cast<double>(print.shape.z) < canopy_m_)) {
        return;
    }
    print.shape.x = std::min(print.shape.x, static_cast<float>(kMostReach_m));
    print.shape.y = std::min(print.shape.y, static_cast<float>(kMostReach_m));
    add(out, print,
        print.kind == shared::kPrintSphere ? static_cast<double>(print.shape.y)
                                           : glm::length(glm::dvec2(print.shape.x, print.shape.y)));
}

/// The body's plane over the ground's, which is taken for even under it.
void PrintList::add_body(std::vector<Print>& out, const Body& body) const {
    const Underside& under = undersides_.at(body.mesh);
    Print print;
    print.kind = shared::kPrintMesh;
    print.now = {body.now[3].x, body.now[3].z};
    print.before = {body.before[3].x, body.before[3].z};
    print.turn_now = heading_of(body.now);
    print.turn_before = heading_of(body.before);
    if (under.texels.empty() || !finite(glm::dvec3(body.now[3])) ||
        !finite(glm::dvec3(body.before[3]))) {
        return;
    }
    const glm::dvec2 right(print.turn_now), back(-right.y, right.x);
    const glm::dvec2 middle = print.now + right * under.middle.x + back * under.middle.y;
    const auto over = [&](glm::dvec2 own) {
        const glm::dvec2 at = middle + right * own.x + back * own.y;
        return ground_(at.x, at.y);
    };
    const glm::dvec2 half = under.half;
    const glm::dvec2 slope((over({half.x, 0}) - over({-half.x, 0})) / (2 * half.x),
                           (over({0, half.y}) - over({0, -half.y})) / (2 * half.y));
    const glm::dvec2 tilt = glm::dvec2(body.now[0].y, body.now[2].y) - slope;
    const double ground = over({0, 0}) - glm::dot(slope, under.middle);
    double height = std::min(body.now[3].y, body.before[3].y) - ground;
    // Its lowest corner, whatever the tilt, and no deeper in the ground than a canopy.
    const double lowest = height + static_cast<double>(under.lowest_m) +
                          glm::dot(tilt, under.middle) - glm::dot(glm::abs(tilt), half);
    if (!(lowest < canopy_m_)) {
        return;
    }
    height += std::max(-canopy_m_ - (height + static_cast<double>(under.lowest_m)), 0.0);
    print.shape = glm::vec4(0, 0, height, 1);
    print.tilt = glm::vec2(tilt);
    print.map = maps_.first[body.mesh];
    add(out, print, static_cast<double>(under.reach_m));
}

std::vector<Print> PrintList::at(double time_s, double step_s, const Touching& touching) const {
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
        add_shape(out, print);
    }
    for (const Ball& ball : touching.balls) {
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
        add_shape(out, print);
    }
    for (const Body& body : touching.bodies) {
        add_body(out, body);
    }
    return out;
}

} // namespace sward::tracks
