// SPDX-License-Identifier: Apache-2.0
#include "blades/surface_area.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/angles.h"

namespace sward::blades {

namespace {

constexpr int kMostCrossings = 256; // of a walk: a tuft on slivers ends early rather than never

/// Number of the first vertex with the same position, bit for bit (-0 is 0).
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size()), same(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = static_cast<std::uint32_t>(i);
    }
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3 p = positions[a], q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && positions[order[i]] == positions[order[i - 1]];
        same[order[i]] = again ? same[order[i - 1]] : order[i];
    }
    return same;
}

/// An edge of a triangle, its ends in order of their number.
struct Edge {
    std::uint32_t a, b, triangle;
    int k;
};

} // namespace

SurfaceArea::SurfaceArea(const scene::Mesh& mesh, double slope_deg) : mesh_(mesh) {
    const double least_up = slope_deg >= 180 ? -2 : std::cos(slope_deg * base::kDegree);
    cumulative_.reserve(mesh.triangles.size());
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const double own = area(t);
        sum += own > 0 && face_normal(t).y >= least_up ? own : 0;
        cumulative_.push_back(sum);
    }
}

double SurfaceArea::area(std::uint32_t t) const {
    return 0.5 * glm::length(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
}

glm::dvec3 SurfaceArea::face_normal(std::uint32_t t) const {
    const glm::dvec3 n = glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    const double size = glm::length(n);
    return size > 0 ? n / size : glm::dvec3(0, 1, 0);
}

SurfacePoint SurfaceArea::sample(glm::dvec3 u) const {
    // upper_bound: a triangle without area, whose end is where it begins, is never found.
    auto at = std::upper_bound(cumulative_.begin(), cumulative_.end(), u.x * total_m2());
    if (at == cumulative_.end()) { // u.x * total rounded up
        at = std::lower_bound(cumulative_.begin(), cumulative_.end(), total_m2());
    }
    const auto t = static_cast<std::uint32_t>(at - cumulative_.begin());
    const double root = std::sqrt(u.y);
    return {(1 - root) * corner(t, 0) + root * (1 - u.z) * corner(t, 1) + root * u.z * corner(t, 2),
            t};
}

glm::dvec3 SurfaceArea::normal(const SurfacePoint& at) const {
    const glm::dvec3 a = corner(at.triangle, 0), b = corner(at.triangle, 1),
                     c = corner(at.triangle, 2);
    const glm::dvec3 face = glm::cross(b - a, c - a);
    const double whole = glm::dot(face, face);
    const double v = glm::dot(glm::cross(at.place - a, c - a), face) / whole;
    const double w = glm::dot(glm::cross(b - a, at.place - a), face) / whole;
    const auto& corners = mesh_.triangles[at.triangle];
    const glm::dvec3 mixed = (1 - v - w) * glm::dvec3(mesh_.normals[corners[0]]) +
                             v * glm::dvec3(mesh_.normals[corners[1]]) +
                             w * glm::dvec3(mesh_.normals[corners[2]]);
    const double size = glm::length(mixed);
    const glm::dvec3 own = face / std::sqrt(whole);
    return size > 1e-3 && glm::dot(mixed, own) > 0.1 * size ? mixed / size : own;
}

void SurfaceArea::link_neighbours() {
    const std::vector<std::uint32_t> same = weld(mesh_.positions);
    std::vector<Edge> edges;
    edges.reserve(3 * mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const bool grows = covered(t);
        for (int k = 0; grows && k < 3; ++k) {
            const std::uint32_t a = same[mesh_.triangles[t][static_cast<std::size_t>(k)]];
            const std::uint32_t b = same[mesh_.triangles[t][static_cast<std::size_t>((k + 1) % 3)]];
            edges.push_back({std::min(a, b), std::max(a, b), t, k});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
        return e.a != f.a                 ? e.a < f.a
               : e.b != f.b               ? e.b < f.b
               : e.triangle != f.triangle ? e.triangle < f.triangle
                                          : e.k < f.k;
    });
    across_.assign(mesh_.triangles.size(), {kNone, kNone, kNone});
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const Edge &e = edges[i], &f = edges[i + 1];
        if (e.a == f.a && e.b == f.b &&
            e.triangle != f.triangle) { // of three or more at an edge, each knows the one beside it
            across_[e.triangle][static_cast<std::size_t>(e.k)] = f.triangle;
            if (across_[f.triangle][static_cast<std::size_t>(f.k)] == kNone) {
                across_[f.triangle][static_cast<std::size_t>(f.k)] = e.triangle;
            }
        }
    }
}

SurfacePoint SurfaceArea::walk(SurfacePoint from, glm::dvec3 way, double by) const {
    std::uint32_t before = kNone;
    for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
        const glm::dvec3 n = face_normal(from.triangle);
        way -= n * glm::dot(way, n);
        const double size = glm::length(way);
        if (!(size > 1e-9)) {
            return from;
        }
        way /= size;
        // The edge that the walk leaves by: the nearest that it nears, but for the one it came
        // through.
        double least = std::numeric_limits<double>::infinity();
        int edge = -1;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = corner(from.triangle, k);
            const glm::dvec3 out = glm::cross(corner(from.triangle, (k + 1) % 3) - a, n);
            const double nearing = glm::dot(way, out);
            const std::uint32_t beyond = across_[from.triangle][static_cast<std::size_t>(k)];
            if (nearing <= 0 || (before != kNone && beyond == before)) {
                continue;
            }
            const double reach = std::max(glm::dot(a - from.place, out) / nearing, 0.0);
            if (reach < least) {
                least = reach;
                edge = k;
            }
        }
        if (edge < 0 || by <= least) {
            from.place += way * (edge < 0 ? 0 : by);
            return from;
        }
        from.place += way * least;
        by -= least;
        const std::uint32_t next = across_[from.triangle][static_cast<std::size_t>(edge)];
        if (next == kNone) {
            return from;
        }
        // Unfolded about the edge: what runs along it stays, what runs out of one triangle runs
        // into the other.
        const glm::dvec3 a = corner(from.triangle, edge);
        const glm::dvec3 along = glm::normalize(corner(from.triangle, (edge + 1) % 3) - a);
        const glm::dvec3 middle = (corner(next, 0) + corner(next, 1) + corner(next, 2)) / 3.0 - a;
        const glm::dvec3 inward = glm::normalize(middle - along * glm::dot(middle, along));
        const double kept = glm::dot(way, along);
        way = along * kept + inward * std::sqrt(std::max(1 - kept * kept, 0.0));
        before = from.triangle;
        from.triangle = next;
    }
    return from;
}

} // namespace sward::blades
