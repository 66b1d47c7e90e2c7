// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/blade_mesh.h"

#include <algorithm>
#include <cmath>

#include "shared/shading.h"

namespace sward::texgen {
namespace {

using shared::BladeRecord;
using shared::vec2;
using shared::vec3;

/// A cross-section of the strip.
struct Station {
    float v = 0;       ///< along the blade
    float width = 0;   ///< over the greatest
    float colour = 0;  ///< v whose colour it has
    bool joins = true; ///< triangles join it to the one before
};

/// From root to tip; the tip is a point. Where a head begins there are two at one place, the
/// stalk's colour and the head's.
std::vector<Station> stations_of(const shared::GrassAppearance& look, int segments) {
    std::vector<Station> all;
    for (int i = 0; i < segments; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(segments);
        const float v = shared::blade_station(t, look.outline);
        all.push_back({v, shared::blade_width_at(v, look.outline), v});
        if (look.outline.head_from < 1 && 2 * i == segments)
            all.push_back({v, all.back().width, 1, false});
    }
    all.push_back({1, 0, 1});
    return all;
}

/// Area of the outline over that of its strip: few segments cut its curve short.
float area_kept(const shared::GrassAppearance& look, std::span<const Station> stations) {
    constexpr int kSteps = 512;
    double whole = 0, strip = 0;
    for (int i = 0; i < kSteps; ++i)
        whole +=
            shared::blade_width_at((static_cast<float>(i) + 0.5f) / kSteps, look.outline) / kSteps;
    for (std::size_t i = 1; i < stations.size(); ++i)
        strip +=
            0.5 * (stations[i].width + stations[i - 1].width) * (stations[i].v - stations[i - 1].v);
    return static_cast<float>(whole / strip);
}

void put(std::vector<float>& out, vec3 v) {
    out.insert(out.end(), {v.x, v.y, v.z});
}
void put(std::vector<float>& out, vec2 v) {
    out.insert(out.end(), {v.x, v.y});
}

class BladeWriter {
public:
    BladeWriter(BladeMesh& mesh, const BladeRecord& blade, const shared::GrassAppearance& look,
                float widen)
        : mesh_(mesh), blade_(blade), look_(look), half_(blade.v1.w * widen),
          across_(shared::blade_width_direction(blade.shape.x)) {
        // Its front is the side that faces the sky half-way up: engines that draw one side draw
        // that.
        front_ =
            shared::cross(across_, shared::blade_tangent(vec3(blade.v1), vec3(blade.v2), 0.5f)).y <
                    0
                ? -1.0f
                : 1.0f;
    }

    void write(std::span<const Station> stations) {
        std::uint32_t before = 0;
        for (std::size_t i = 0; i < stations.size(); ++i) {
            const auto first = static_cast<std::uint32_t>(mesh_.vertices());
            const bool tip = i + 1 == stations.size();
            if (tip)
                vertex(stations[i], 0.5f);
            else
                for (const float u : {0.0f, 1.0f})
                    vertex(stations[i], u);
            if (i > 0 && stations[i].joins) {
                triangle(before, before + 1, first);
                if (!tip)
                    triangle(before + 1, first + 1, first);
            }
            before = first;
        }
    }

private:
    void vertex(const Station& station, float u) {
        const vec3 v1(blade_.v1), v2(blade_.v2), root(blade_.root.x, 0, blade_.root.y);
        const vec3 place = root + shared::blade_curve(v1, v2, station.v) +
                           across_ * (half_ * station.width * (2 * u - 1));
        vec3 normal = shared::cross(across_, shared::blade_tangent(v1, v2, station.v)) * front_;
        normal = shared::length(normal) > 1e-4f ? shared::normalize(normal) : vec3(0, 1, 0);
        const float weight = station.v * station.v;
        put(mesh_.positions, place);
        put(mesh_.normals, normal);
        put(mesh_.uvs, vec2(u, 1 - station.v));
        put(mesh_.wind_uvs, vec2(weight, blade_.root.w));
        put(mesh_.winds, vec3(weight, blade_.root.w, blade_.v2.w));
        put(mesh_.roots, root);
        put(mesh_.blades, vec3(blade_.root.z, blade_.root.w, blade_.shape.y));
        const vec3 albedo =
            shared::blade_albedo(look_, vec2(blade_.root.z, blade_.root.w), station.colour, 1);
        for (int c = 0; c < 3; ++c)
            mesh_.colours.push_back(
                static_cast<std::uint16_t>(std::lround(std::clamp(albedo[c], 0.0f, 1.0f) * 65535)));
        mesh_.colours.push_back(65535);
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (front_ < 0)
            std::swap(b, c);
        mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
    }

    BladeMesh& mesh_;
    const BladeRecord& blade_;
    const shared::GrassAppearance& look_;
    float half_ = 0;
    vec3 across_;
    float front_ = 1;
};

} // namespace

BladeMesh blade_mesh(std::span<const BladeRecord> blades, int species,
                     const shared::GrassAppearance& look, const MeshLod& lod) {
    const auto stations =
        stations_of(look, look.outline.head_from < 1 ? lod.head_segments : lod.segments);
    const auto area = [](const BladeRecord& b) { return static_cast<double>(b.v1.w) * b.shape.y; };
    std::vector<const BladeRecord*> kept;
    double all = 0, standing = 0;
    for (const BladeRecord& blade : blades) {
        if (static_cast<int>(blade.shape.w) != species)
            continue;
        all += area(blade);
        if (kept.empty() || blade.root.z < lod.share) {
            kept.push_back(&blade);
            standing += area(blade);
        }
    }
    BladeMesh mesh;
    if (kept.empty())
        return mesh;
    const float widen = area_kept(look, stations) * static_cast<float>(all / standing);
    for (const BladeRecord* blade : kept)
        BladeWriter(mesh, *blade, look, widen).write(stations);
    return mesh;
}

} // namespace sward::texgen
