// SPDX-License-Identifier: Apache-2.0
#include "tracks/underside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "shared/track_map.h"

namespace sward::tracks {

namespace {

constexpr float kNothing = std::numeric_limits<float>::max();
constexpr double kTexelsACell = 4;
constexpr float kCornerShare = 0.5f; // of half a cell: so near to the thick parts lie corners,
                                     // which are no rails

/// Heights over the mesh's origin, texel by texel; kNothing: no part of the mesh.
struct Plan {
    glm::dvec2 corner{0};
    double texel_m = 0;
    int width = 0, height = 0;
    std::vector<float> low;

    [[nodiscard]] std::size_t count() const { return low.size(); }
    void touch(glm::dvec3 place) {
        const auto x = static_cast<int>(std::floor((place.x - corner.x) / texel_m)),
                   z = static_cast<int>(std::floor((place.z - corner.y) / texel_m));
        if (x >= 0 && z >= 0 && x < width && z < height) {
            float& own = low[static_cast<std::size_t>(z) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x)];
            own = std::min(own, static_cast<float>(place.y));
        }
    }
};

void draw_edge(Plan& plan, glm::dvec3 from, glm::dvec3 to) {
    const double run = glm::length(glm::dvec2(to.x - from.x, to.z - from.z));
    const int taps = static_cast<int>(std::ceil(std::min(2 * run / plan.texel_m, 4096.0)));
    for (int n = 0; n <= taps; ++n) {
        plan.touch(glm::mix(from, to, taps > 0 ? static_cast<double>(n) / taps : 0.0));
    }
}

/// Height of a triangle at the middles of the texels that are inside it.
void draw_inside(Plan& plan, const glm::dvec3 (&corner)[3]) {
    const glm::dvec2 a(corner[0].x, corner[0].z), b(corner[1].x, corner[1].z),
        c(corner[2].x, corner[2].z);
    const auto twice = [](glm::dvec2 one, glm::dvec2 two) { return one.x * two.y - one.y * two.x; };
    const double area = twice(b - a, c - a);
    if (std::abs(area) < 1e-12) { // upright: its edges have it
        return;
    }
    const glm::dvec2 least = (glm::min(a, glm::min(b, c)) - plan.corner) / plan.texel_m,
                     most = (glm::max(a, glm::max(b, c)) - plan.corner) / plan.texel_m;
    const int x0 = static_cast<int>(std::clamp(least.x, 0.0, 1.0 * plan.width)),
              x1 = static_cast<int>(std::clamp(most.x + 1, 0.0, 1.0 * plan.width)),
              z0 = static_cast<int>(std::clamp(least.y, 0.0, 1.0 * plan.height)),
              z1 = static_cast<int>(std::clamp(most.y + 1, 0.0, 1.0 * plan.height));
    for (int z = z0; z < z1; ++z) {
        for (int x = x0; x < x1; ++x) {
            const glm::dvec2 at = plan.corner + (glm::dvec2(x, z) + 0.5) * plan.texel_m;
            const double u = twice(b - at, c - at) / area, v = twice(c - at, a - at) / area,
                         w = 1 - u - v;
            if (u >= 0 && v >= 0 && w >= 0) {
                plan.touch({at.x, u * corner[0].y + v * corner[1].y + w * corner[2].y, at.y});
            }
        }
    }
}

/// Of every texel the nearest one that is marked, -1: none is, and how far it is (texels).
struct Nearest {
    std::vector<int> texel;
    std::vector<float> away;
};

/// Along rows first, then the least over the rows: exact.
Nearest nearest_of(const std::vector<bool>& marked, int width, int height) {
    std::vector<int> column(marked.size(), -1); // of the nearest marked one in the row
    for (int z = 0; z < height; ++z) {
        const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(width);
        int last = -1;
        for (int x = 0; x < width; ++x) {
            last = marked[row + static_cast<std::size_t>(x)] ? x : last;
            column[row + static_cast<std::size_t>(x)] = last;
        }
        last = -1;
        for (int x = width - 1; x >= 0; --x) {
            int& own = column[row + static_cast<std::size_t>(x)];
            last = marked[row + static_cast<std::size_t>(x)] ? x : last;
            own = last >= 0 && (own < 0 || last - x < x - own) ? last : own;
        }
    }
    Nearest out{std::vector<int>(marked.size(), -1), std::vector<float>(marked.size(), kNothing)};
    for (int z = 0; z < height; ++z) {
        for (int x = 0; x < width; ++x) {
            int best = std::numeric_limits<int>::max(), found = -1;
            for (int away = 0; away < height && away * away < best; ++away) {
                for (const int row : {z - away, z + away}) {
                    if (row < 0 || row >= height) {
                        continue;
                    }
                    const int at = column[static_cast<std::size_t>(row * width + x)];
                    const int square = at < 0 ? best : away * away + (at - x) * (at - x);
                    found = square < best ? row * width + at : found;
                    best = std::min(best, square);
                }
            }
            if (found >= 0) {
                const auto own = static_cast<std::size_t>(z * width + x);
                out.texel[own] = found;
                out.away[own] = std::sqrt(static_cast<float>(best));
            }
        }
    }
    return out;
}

template<class Test> std::vector<bool> where(std::size_t count, Test test) {
    std::vector<bool> out(count);
    for (std::size_t n = 0; n < count; ++n) {
        out[n] = test(n);
    }
    return out;
}

Plan plan_of(const scene::Mesh& mesh, double cell_m, double most_m) {
    glm::dvec2 least(1e30), most(-1e30);
    for (const glm::vec3& position : mesh.positions) {
        least = glm::min(least, glm::dvec2(position.x, position.z));
        most = glm::max(most, glm::dvec2(position.x, position.z));
    }
    least = glm::clamp(least, glm::dvec2(-most_m), glm::dvec2(most_m));
    most = glm::clamp(most, glm::dvec2(-most_m), glm::dvec2(most_m));
    Plan plan;
    const glm::dvec2 size = most - least + 2 * cell_m; // what is made a cell wide fits
    plan.texel_m =
        std::max(cell_m / kTexelsACell, std::max(size.x, size.y) / (shared::kMostMapSide - 3));
    plan.width = static_cast<int>(std::ceil(size.x / plan.texel_m)) + 2;
    plan.height = static_cast<int>(std::ceil(size.y / plan.texel_m)) + 2;
    plan.corner = 0.5 * (least + most) - 0.5 * plan.texel_m * glm::dvec2(plan.width, plan.height);
    plan.low.assign(static_cast<std::size_t>(plan.width) * static_cast<std::size_t>(plan.height),
                    kNothing);
    for (const auto& triangle : mesh.triangles) {
        const glm::dvec3 corners[3] = {mesh.positions[triangle[0]], mesh.positions[triangle[1]],
                                       mesh.positions[triangle[2]]};
        draw_inside(plan, corners);
        for (int n = 0; n < 3; ++n) {
            draw_edge(plan, corners[n], corners[(n + 1) % 3]);
        }
    }
    return plan;
}

/// The middle lines of parts narrower than a cell.
std::vector<bool> rails_of(const Plan& plan, float half) {
    const auto covered = [&](std::size_t n) { return plan.low[n] < kNothing; };
    const Nearest outside = nearest_of(
        where(plan.count(), [&](std::size_t n) { return !covered(n); }), plan.width, plan.height);
    const Nearest thick =
        nearest_of(where(plan.count(), [&](std::size_t n) { return outside.away[n] > half; }),
                   plan.width, plan.height);
    return where(plan.count(), [&](std::size_t n) {
        if (!covered(n) || !(thick.away[n] > (1 + kCornerShare) * half)) {
            return false;
        }
        const int x = static_cast<int>(n) % plan.width, z = static_cast<int>(n) / plan.width;
        for (int by = 0; by < 9; ++by) { // the rim of the map is never covered
            const int beside = (z + by / 3 - 1) * plan.width + x + by % 3 - 1;
            if (outside.away[static_cast<std::size_t>(beside)] > outside.away[n]) {
                return false;
            }
        }
        return true;
    });
}

/// Parts narrower than a cell made a cell wide, at the height of what is next to them.
void widen(Plan& plan, double cell_m) {
    const auto half = static_cast<float>(0.5 * cell_m / plan.texel_m);
    const Nearest near = nearest_of(rails_of(plan, half), plan.width, plan.height);
    for (std::size_t n = 0; n < plan.count(); ++n) {
        if (plan.low[n] == kNothing && near.away[n] <= half) {
            plan.low[n] = plan.low[static_cast<std::size_t>(near.texel[n])];
        }
    }
}

/// Nothing is left that is higher than what counts, nor in the map's own rim.
void cut_off(Plan& plan, float highest) {
    for (std::size_t n = 0; n < plan.count(); ++n) {
        const int x = static_cast<int>(n) % plan.width, z = static_cast<int>(n) / plan.width;
        const bool rim = x == 0 || z == 0 || x == plan.width - 1 || z == plan.height - 1;
        plan.low[n] = plan.low[n] < highest && !rim ? plan.low[n] : kNothing;
    }
}

void fill_texels(const Plan& plan, Underside& out) {
    const auto covered = [&](std::size_t n) { return plan.low[n] < kNothing; };
    const Nearest inside = nearest_of(where(plan.count(), covered), plan.width, plan.height),
                  outside =
                      nearest_of(where(plan.count(), [&](std::size_t n) { return !covered(n); }),
                                 plan.width, plan.height);
    const auto side = static_cast<float>(plan.texel_m);
    out.middle = plan.corner + 0.5 * plan.texel_m * glm::dvec2(plan.width, plan.height);
    out.half = 0.5 * plan.texel_m * glm::dvec2(plan.width, plan.height);
    out.reach_m = static_cast<float>(glm::length(glm::abs(out.middle) + out.half));
    out.texels = {glm::vec4(glm::vec2(plan.corner), side, 0),
                  glm::vec4(plan.width, plan.height, 0, 0)};
    for (std::size_t n = 0; n < plan.count(); ++n) {
        const bool in = covered(n);
        const int to = in ? outside.texel[n] : inside.texel[n];
        const auto own = static_cast<int>(n);
        glm::vec2 way(to % plan.width - own % plan.width, to / plan.width - own / plan.width);
        way *= in ? 1.0f : -1.0f;
        // A rim runs between two texels' middles.
        const float from_rim = in ? outside.away[n] - 0.5f : 0.5f - inside.away[n];
        const float low = in ? plan.low[n] : plan.low[static_cast<std::size_t>(inside.texel[n])];
        out.texels.emplace_back(low, from_rim * side, glm::normalize(way));
    }
}

} // namespace

Underside underside_of(const scene::Mesh& mesh, double cell_m, double canopy_m, double most_m) {
    Plan plan = plan_of(mesh, cell_m, most_m);
    Underside out;
    out.lowest_m = *std::min_element(plan.low.begin(), plan.low.end());
    if (out.lowest_m == kNothing) {
        return out;
    }
    cut_off(plan, out.lowest_m + 2 * static_cast<float>(canopy_m));
    if (std::all_of(plan.low.begin(), plan.low.end(), [](float low) { return low == kNothing; })) {
        return out;
    }
    widen(plan, cell_m);
    fill_texels(plan, out);
    return out;
}

UndersideMaps joined(std::span<const Underside> undersides) {
    UndersideMaps out;
    for (const Underside& one : undersides) {
        out.first.push_back(static_cast<int>(out.texels.size()));
        out.texels.insert(out.texels.end(), one.texels.begin(), one.texels.end());
    }
    out.texels.resize(std::max<std::size_t>(out.texels.size(), 1));
    return out;
}

} // namespace sward::tracks
