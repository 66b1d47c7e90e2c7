// SPDX-License-Identifier: Apache-2.0
// A grass set's blades on a mesh: where a triangle lies on its chart, it takes the blades that the
// patches there have in it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"
#include "blades/surface_placement.h"
#include "shared/bindings.h"
#include "shared/surface_chart.h"

namespace sward::blades {

namespace {

// A chart is smaller than the surface that it shows; what it lacks of blades comes from this place
// of the patch (in sides).
constexpr glm::dvec2 kMorePlace = {0.381966, 0.618034};
constexpr double kMostStretch = 2; // of a triangle that is off its chart by more than any should be

/// A variant's blades by cells of the patch.
class PatchCells {
public:
    explicit PatchCells(const grass::GrassSet& set)
        : set_(set),
          cells_(std::clamp(static_cast<int>(std::sqrt(static_cast<double>(set.blades.size()) /
                                                       std::max(set.variants, 1) / 4)),
                            1, 256)) {
        for (int variant = 0; variant < set.variants; ++variant) {
            auto& cells = of_variant_.emplace_back(static_cast<std::size_t>(cells_) *
                                                   static_cast<std::size_t>(cells_));
            for (std::uint32_t i = set.variant_begin[static_cast<std::size_t>(variant)];
                 i < set.variant_begin[static_cast<std::size_t>(variant) + 1]; ++i) {
                const glm::ivec2 at =
                    glm::clamp(glm::ivec2(glm::vec2(set.blades[i].root) / cell_m()), 0, cells_ - 1);
                cells[index(at)].push_back(i);
            }
        }
    }
    [[nodiscard]] float cell_m() const { return set_.side_m / static_cast<float>(cells_); }

    /// Calls found(blade, place on the plane) for the blades of the cells that meet a box of the
    /// plane, tiled with patches.
    template<class Found> void each(glm::dvec2 low, glm::dvec2 high, Found found) const {
        const glm::ivec2 first(glm::floor(low / double(cell_m()))),
            last(glm::floor(high / double(cell_m())));
        for (int j = first.y; j <= last.y; ++j) {
            for (int i = first.x; i <= last.x; ++i) {
                const glm::ivec2 tile(glm::floor(glm::dvec2(i, j) / double(cells_)));
                const auto variant =
                    static_cast<std::size_t>(shared::tile_variant(tile, set_.variants));
                for (const std::uint32_t blade :
                     of_variant_[variant][index(glm::ivec2(i, j) - tile * cells_)]) {
                    found(set_.blades[blade], glm::dvec2(tile) * double(set_.side_m) +
                                                  glm::dvec2(set_.blades[blade].root));
                }
            }
        }
    }

private:
    [[nodiscard]] std::size_t index(glm::ivec2 at) const {
        return static_cast<std::size_t>(at.y * cells_ + at.x);
    }
    const grass::GrassSet& set_;
    int cells_; ///< a side
    std::vector<std::vector<std::vector<std::uint32_t>>> of_variant_;
};

/// A triangle as its chart sees it.
struct ChartTriangle {
    std::array<glm::dvec2, 3> corners;
    double twice_area;

    /// Weights of the corners at a place; none negative inside.
    [[nodiscard]] glm::dvec3 weights(glm::dvec2 at) const {
        const auto part = [&](glm::dvec2 a, glm::dvec2 b) {
            return ((b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x)) / twice_area;
        };
        return {part(corners[1], corners[2]), part(corners[2], corners[0]),
                part(corners[0], corners[1])};
    }
};

ChartTriangle on_chart(const SurfaceArea& area, std::uint32_t triangle, int chart) {
    ChartTriangle out{};
    for (int k = 0; k < 3; ++k) {
        out.corners[static_cast<std::size_t>(k)] =
            glm::dvec2(shared::chart_place(chart, glm::vec3(area.corner(triangle, k))));
    }
    const glm::dvec2 a = out.corners[1] - out.corners[0], b = out.corners[2] - out.corners[0];
    out.twice_area = a.x * b.y - a.y * b.x;
    return out;
}

shared::SurfaceBlade laid_down(const shared::BladeRecord& blade, glm::vec3 root,
                               const shared::SurfaceFrame& frame) {
    const glm::vec3 across =
        shared::from_surface(frame, shared::blade_width_direction(blade.shape.x));
    const glm::vec3 first = shared::surface_width_direction(frame.up, 0),
                    second = shared::surface_width_direction(frame.up, 0.5f * shared::kPi);
    float turn = std::atan2(glm::dot(across, second), glm::dot(across, first));
    turn += turn < 0 ? 2 * shared::kPi : 0;
    turn = std::clamp(turn, 1e-3f, 2 * shared::kPi - 1e-3f) + 2 * shared::kPi * blade.shape.w;
    return {glm::vec4(root, turn),
            glm::vec4(shared::from_surface(frame, glm::vec3(blade.v1)), blade.shape.y),
            glm::vec4(shared::from_surface(frame, glm::vec3(blade.v2)), blade.v1.w),
            glm::vec4(frame.up, blade.v2.w)};
}

/// Adds the blades of one triangle.
class Layer {
public:
    Layer(const SurfaceArea& area, const SetPlacing& placing)
        : area_(area), placing_(placing), cells_(placing.set) {}

    void add(std::uint32_t triangle, std::vector<shared::SurfaceBlade>& blades) const {
        const glm::vec3 normal(area_.face_normal(triangle));
        const int chart = shared::chart_of(normal);
        const ChartTriangle flat = on_chart(area_, triangle, chart);
        if (flat.twice_area == 0) {
            return;
        }
        const double stretch = std::min(
            1.0 / std::max(glm::dot(normal, shared::chart_up(chart)), 1e-3f), kMostStretch);
        take(triangle, chart, flat, {0, 0, 1}, blades);
        take(triangle, chart, flat, {kMorePlace * double(placing_.set.side_m), stretch - 1},
             blades);
    }

private:
    /// `from`: place of the plane that is read, over the chart's; share of the blades by rank.
    void take(std::uint32_t triangle, int chart, const ChartTriangle& flat, glm::dvec3 from,
              std::vector<shared::SurfaceBlade>& blades) const {
        const glm::dvec2 shift(from);
        const glm::dvec2 low =
            glm::min(flat.corners[0], glm::min(flat.corners[1], flat.corners[2])) + shift;
        const glm::dvec2 high =
            glm::max(flat.corners[0], glm::max(flat.corners[1], flat.corners[2])) + shift;
        cells_.each(low, high, [&](const shared::BladeRecord& blade, glm::dvec2 place) {
            const glm::dvec3 weights = flat.weights(place - shift);
            if (blade.root.z >= from.z || blade.root.w >= placing_.density ||
                std::min({weights.x, weights.y, weights.z}) < 0) {
                return;
            }
            const glm::dvec3 root = weights.x * area_.corner(triangle, 0) +
                                    weights.y * area_.corner(triangle, 1) +
                                    weights.z * area_.corner(triangle, 2);
            const glm::vec3 up(area_.normal({root, triangle}));
            blades.push_back(laid_down(blade, glm::vec3(root), shared::surface_frame(chart, up)));
        });
    }

    const SurfaceArea& area_;
    const SetPlacing& placing_;
    PatchCells cells_;
};

void check_count(double area_m2, const SetPlacing& placing, const std::filesystem::path& file) {
    if (!(area_m2 > 0)) {
        throw base::input_error(
            base::ExitCode::kBadInput, file, 0, "surface",
            placing.slope_deg < 180
                ? fmt::format("no area that leans at most {} degrees", placing.slope_deg)
                : "no area",
            "a mesh with a surface");
    }
    const double count = area_m2 * placing.set.density_per_m2 * placing.density;
    if (!(count <= static_cast<double>(kMostSurfaceBlades))) {
        throw base::input_error(
            base::ExitCode::kOverLimit, file, 0, "surface",
            fmt::format("{:.0f} blades ({:.6g} m2 at {:.6g} a square metre)", count, area_m2,
                        placing.set.density_per_m2 * placing.density),
            fmt::format("at most {}; surface_grass.density makes it less", kMostSurfaceBlades));
    }
}

} // namespace

SurfaceBlades place_set_on_surface(const scene::Mesh& mesh, const SetPlacing& placing,
                                   const std::filesystem::path& file) {
    check_surface(mesh, file);
    const SurfaceArea area(mesh, placing.slope_deg);
    check_count(area.total_m2(), placing, file);
    std::vector<shared::SurfaceBlade> laid;
    const Layer layer(area, placing);
    for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        if (area.covered(triangle)) {
            layer.add(triangle, laid);
        }
    }
    std::vector<glm::vec3> places;
    places.reserve(laid.size());
    for (const shared::SurfaceBlade& blade : laid) {
        places.emplace_back(blade.root_direction);
    }
    SurfaceBlades out;
    out.area_m2 = area.total_m2();
    out.blades.reserve(laid.size());
    for (const std::uint32_t i : balanced_order(places, CULL_GROUP)) {
        out.blades.push_back(laid[i]);
    }
    for (std::size_t first = 0; first < out.blades.size(); first += CULL_GROUP) {
        add_cluster(out, first, std::min<std::size_t>(first + CULL_GROUP, out.blades.size()));
    }
    return out;
}

} // namespace sward::blades
