// SPDX-License-Identifier: Apache-2.0
#include "blades/colliders.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"
#include "shared/tile_lie.h"

namespace sward::blades {

namespace {

constexpr double kLaidSlack_m = 1e-4; // where a root lies is rounded

bool finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_sphere(glm::dvec3 centre, double radius_m, const std::string& where) {
    if (!(radius_m > 0) || !std::isfinite(radius_m)) {
        throw base::Error(
            base::ExitCode::kBadInput,
            fmt::format("{}: radius: found {} m, expected a number above 0", where, radius_m));
    }
    if (!finite(centre)) {
        throw base::Error(base::ExitCode::kBadInput,
                          fmt::format("{}: place: found {}, {}, {}, expected finite numbers", where,
                                      centre.x, centre.y, centre.z));
    }
}

/// Up to 45 degrees.
bool upright(const glm::dmat4& frame) {
    return frame[1].y > 0.7 * glm::length(glm::dvec3(frame[1]));
}

bool meets(const Box& box, glm::dvec2 low, glm::dvec2 high) {
    return box.low.x <= high.x && box.high.x >= low.x && box.low.z <= high.y && box.high.z >= low.y;
}

/// Does a box meet the roots of a patch (least x, z, most x, z in the set) as they lie on the tile
/// at `corner`? The shift may have parted them: they go on at the tile's other end.
bool meets_laid(const Box& box, glm::dvec2 corner, const glm::vec4& roots, double side_m,
                shared::uint lie) {
    const glm::dvec2 a(shared::lie_along(lie, glm::vec2(roots.x, roots.y))),
        b(shared::lie_along(lie, glm::vec2(roots.z, roots.w)));
    const glm::dvec2 size = glm::abs(b - a);
    const glm::dvec2 least = glm::min(a, b) + glm::dvec2(shared::lie_shift(lie)) * side_m;
    const glm::dvec2 low = corner + least - glm::floor(least / side_m) * side_m;
    for (int part = 0; part < 4; ++part) {
        const glm::dvec2 from = low - glm::dvec2(part & 1, part >> 1) * side_m;
        if (meets(box, from - kLaidSlack_m, from + size + kLaidSlack_m)) {
            return true;
        }
    }
    return false;
}

/// Calls `found(patch)` for every patch of the pool that a box meets.
template<class Found>
void each_patch(const Pages& pages, double side_m, const Box& box, Found found) {
    const glm::ivec2 low(glm::floor(glm::dvec2(box.low.x, box.low.z) / side_m)),
        high(glm::floor(glm::dvec2(box.high.x, box.high.z) / side_m));
    const MortonOrder& order = pages.order();
    const auto visit = [&](int slot) {
        const Pages::Page& page = pages.slots()[static_cast<std::size_t>(slot)];
        if (box.low.y > page.ground.y || box.high.y < page.ground.x) {
            return;
        }
        const glm::dvec2 corner = glm::dvec2(page.tile) * side_m;
        const shared::uint lie = shared::tile_lie(page.tile);
        const std::size_t first = order.box_begin[static_cast<std::size_t>(page.variant)],
                          end = order.box_begin[static_cast<std::size_t>(page.variant) + 1];
        for (std::size_t n = first; n < end; ++n) {
            if (meets_laid(box, corner, order.boxes[n], side_m, lie)) {
                found(static_cast<std::uint32_t>(slot * order.patches_a_page +
                                                 static_cast<int>(n - first)));
            }
        }
    };
    const auto tiles = (static_cast<std::int64_t>(high.x) - low.x + 1) *
                       (static_cast<std::int64_t>(high.y) - low.y + 1);
    if (tiles > static_cast<std::int64_t>(pages.slots().size())) { // a huge or very fast one
        for (std::size_t slot = 0; slot < pages.slots().size(); ++slot) {
            if (pages.slots()[slot].used) {
                visit(static_cast<int>(slot));
            }
        }
        return;
    }
    for (int z = low.y; z <= high.y; ++z) {
        for (int x = low.x; x <= high.x; ++x) {
            if (const int slot = pages.slot_of({x, z}); slot >= 0) {
                visit(slot);
            }
        }
    }
}

} // namespace

Colliders::Colliders(const scene::Scene& scene,
                     const std::map<std::filesystem::path, scene::SphereSet>& packed, Ground ground)
    : file_(scene.file.string()), paths_(scene.paths), ground_(std::move(ground)) {
    for (std::size_t number = 0; number < scene.objects.size(); ++number) {
        const scene::ObjectSpec& object = scene.objects[number];
        if (!object.collides) {
            continue;
        }
        const std::size_t before = bodies_.size();
        const auto body = packed.find(object.mesh);
        if (object.kind != scene::ObjectKind::kSphere && body != packed.end()) {
            add_body(object, body->second.spheres);
        } else if (object.kind == scene::ObjectKind::kSphere) {
            const glm::vec4 whole(0, 0, 0, static_cast<float>(object.radius_m));
            add_body(object, {&whole, 1});
        }
        if (bodies_.size() > before) {
            bodies_.back().number = number;
        }
    }
}

bool Colliders::is_mesh(const Body& body) {
    return body.number != ~std::size_t{0} && body.object.kind != scene::ObjectKind::kSphere;
}

void Colliders::set_body(std::size_t object, const glm::dmat4& world_from_body, double time_s) {
    for (Body& body : bodies_) {
        if (body.number == object) {
            const bool moves = body.placed && body.placed->now_s < time_s;
            body.placed =
                moves ? Placed{body.placed->now, world_from_body, body.placed->now_s, time_s}
                      : Placed{world_from_body, world_from_body, time_s, time_s};
        }
    }
}

void Colliders::add_body(const scene::ObjectSpec& object, std::span<const glm::vec4> spheres) {
    for (const glm::vec4& sphere : spheres) {
        check_sphere(
            object.position + glm::dvec3(sphere), sphere.w,
            fmt::format("{}: [[object]] {}", file_,
                        scene::kObjectKindNames.at(static_cast<std::size_t>(object.kind))));
    }
    bodies_.push_back({object, {spheres.begin(), spheres.end()}, ~std::size_t{0}, {}});
}

glm::dmat4 Colliders::frame(const Body& body, double time_s) const {
    if (body.placed) { // a step turns so little that the straight line between two turns is one
        const double span = body.placed->now_s - body.placed->before_s;
        const double share =
            span > 0 ? glm::clamp((time_s - body.placed->before_s) / span, 0.0, 1.0) : 1.0;
        return body.placed->before * (1 - share) + body.placed->now * share;
    }
    scene::Pose pose = scene::object_pose(body.object, paths_, time_s);
    if (pose.agl) {
        pose.position.y += ground_(pose.position.x, pose.position.z);
    }
    glm::dmat4 frame(base::Heading(pose.yaw_deg).turn());
    frame[3] = glm::dvec4(pose.position, 1);
    return frame;
}

void Colliders::set_host_spheres(std::vector<HostSphere> spheres, double time_s) {
    for (std::size_t n = 0; n < spheres.size(); ++n) {
        check_sphere(spheres[n].centre, spheres[n].radius_m, fmt::format("collider {}", n));
    }
    before_ = std::move(now_);
    now_ = std::move(spheres);
    before_s_ = now_s_;
    now_s_ = time_s;
    if (before_.size() != now_.size() ||
        !(before_s_ < now_s_)) { // others: they have come from nowhere
        before_ = now_;
    }
}

glm::dvec3 Colliders::host_place(std::size_t n, double time_s) const {
    const double span = now_s_ - before_s_,
                 share = span > 0 ? glm::clamp((time_s - before_s_) / span, 0.0, 1.0) : 1.0;
    return glm::mix(before_[n].centre, now_[n].centre, share);
}

std::vector<MovingMesh> Colliders::meshes_at(double time_s, double step_s) const {
    std::vector<MovingMesh> out;
    for (const Body& body : bodies_) {
        const glm::dmat4 now = frame(body, time_s);
        if (is_mesh(body) && upright(now)) {
            out.push_back({body.number, now, frame(body, time_s - step_s)});
        }
    }
    return out;
}

std::vector<MovingSphere> Colliders::spheres(double time_s, double step_s, bool of_meshes) const {
    std::vector<MovingSphere> out;
    for (const Body& body : bodies_) {
        const glm::dmat4 now = frame(body, time_s), before = frame(body, time_s - step_s);
        if (!of_meshes && is_mesh(body) && upright(now)) {
            continue;
        }
        for (const glm::vec4& sphere : body.spheres) {
            const glm::dvec4 own(glm::vec3(sphere), 1);
            out.push_back({glm::dvec3(now * own), glm::dvec3(before * own), sphere.w});
        }
    }
    for (std::size_t n = 0; n < now_.size(); ++n) {
        out.push_back({host_place(n, time_s), host_place(n, time_s - step_s), now_[n].radius_m});
    }
    return out;
}

Box swept_box(const MovingSphere& sphere, double reach_m) {
    const glm::dvec3 out(sphere.radius_m + reach_m);
    return {glm::min(sphere.centre, sphere.before) - out,
            glm::max(sphere.centre, sphere.before) + out};
}

SphereLists sphere_lists(const Pages& pages, double side_m, double reach_m,
                         std::span<const MovingSphere> spheres, glm::dvec3 anchor) {
    const std::size_t patches =
        pages.slots().size() * static_cast<std::size_t>(pages.order().patches_a_page);
    return sphere_lists(patches, spheres, anchor,
                        [&](const MovingSphere& sphere, const Found& found) {
                            each_patch(pages, side_m, swept_box(sphere, reach_m), found);
                        });
}

SphereLists sphere_lists(std::size_t patches, std::span<const MovingSphere> spheres,
                         glm::dvec3 anchor,
                         const std::function<void(const MovingSphere&, const Found&)>& meet) {
    SphereLists out;
    out.lists.assign(2 * patches, 0);
    struct Pair {
        std::uint32_t patch, sphere;
    };
    std::vector<Pair> pairs;
    for (const MovingSphere& sphere : spheres) {
        const auto number = static_cast<std::uint32_t>(out.spheres.size());
        const std::size_t before = pairs.size();
        meet(sphere, [&](std::uint32_t patch) { pairs.push_back({patch, number}); });
        if (pairs.size() > before) {
            out.spheres.push_back(
                {glm::vec4(glm::vec3(sphere.centre - anchor), static_cast<float>(sphere.radius_m)),
                 glm::vec4(glm::vec3(sphere.before - anchor), 0)});
        }
    }
    for (const Pair& pair : pairs) {
        ++out.lists[2 * pair.patch + 1];
    }
    auto next = static_cast<std::uint32_t>(2 * patches);
    for (std::size_t patch = 0; patch < patches; ++patch) {
        out.lists[2 * patch] = next;
        next += out.lists[2 * patch + 1];
    }
    out.lists.resize(next);
    std::vector<std::uint32_t> filled(patches, 0);
    for (const Pair& pair : pairs) { // in the order of the spheres, in each patch
        out.lists[out.lists[2 * pair.patch] + filled[pair.patch]++] = pair.sphere;
    }
    out.pairs = pairs.size();
    return out;
}

} // namespace sward::blades
