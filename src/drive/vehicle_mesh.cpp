// SPDX-License-Identifier: Apache-2.0
#include "drive/vehicle_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "scene/mesh_build.h"

namespace sward::drive {
namespace {

using glm::dvec2;
using glm::dvec3;
using scene::add_outward;
using scene::add_quad;

constexpr double kBelt = 0.54; // of the body's height: where windows begin
constexpr double kArch = 1.12; // of a wheel's radius
constexpr int kStations = 48;  // along the body; an arch is some ten of them
constexpr int kSpokes = 24;
constexpr double kGap_m = 0.08; // from a high wheel to the body between the wheels

/// A bar from one end to the other, `thick` wide along x and z.
void add_pillar(scene::Mesh& mesh, const dvec3& foot, const dvec3& head, double thick) {
    const dvec3 x(thick / 2, 0, 0), z(0, 0, thick / 2);
    const dvec3 corners[] = {-x - z, x - z, x + z, -x + z};
    for (int i = 0; i < 4; ++i) {
        const dvec3 &a = corners[i], &b = corners[(i + 1) % 4];
        add_outward(mesh, (foot + head) / 2.0, {foot + b, foot + a, head + a, head + b});
    }
}

/// A height over the length: between points (z, y) that follow one another.
double along(const std::vector<dvec2>& line, double z) {
    for (std::size_t i = 1; i < line.size(); ++i)
        if (z <= line[i].x) {
            const double share =
                std::clamp((z - line[i - 1].x) / (line[i].x - line[i - 1].x), 0.0, 1.0);
            return line[i - 1].y + share * (line[i].y - line[i - 1].y);
        }
    return line.back().y;
}

/// The body's underside: level, raised over the wheels.
double underside(const VehicleSpec& spec, double z) {
    double under = spec.clearance_m;
    for (const AxleSpec& axle : spec.axles) {
        const double radius = kArch * axle.radius_m, away = z + axle.ahead_m;
        if (std::abs(away) < radius)
            under = std::max(under, axle.radius_m + std::sqrt(radius * radius - away * away));
    }
    return under;
}

/// Half its width: where a wheel is higher than the body, that stands between the wheels.
double half_width(const VehicleSpec& spec, double z, double top) {
    double half = spec.size_m.x / 2;
    for (const AxleSpec& axle : spec.axles)
        if (const double radius = kArch * axle.radius_m;
            axle.radius_m + radius > top && std::abs(z + axle.ahead_m) < radius + kGap_m)
            half = std::min(half, std::max(0.1, axle.track_m / 2 - axle.width_m / 2 - kGap_m));
    return half;
}

double middle_of(const VehicleSpec& spec) {
    return -(spec.axles[0].ahead_m + spec.axles[1].ahead_m) / 2; // bodies stand over both axles
}

} // namespace

scene::Mesh body_mesh(const VehicleSpec& spec) {
    const double low = spec.clearance_m, h = spec.size_m.y, l = spec.size_m.z, z0 = middle_of(spec);
    const std::vector<dvec2> top = {
        {-0.5, 0.36}, {-0.46, 0.44}, {-0.18, kBelt}, {0.44, kBelt}, {0.5, 0.46}};
    const auto upper = [&](double z) { return low + h * along(top, z / l); };
    scene::Mesh mesh;
    for (int i = 0; i < kStations; ++i) {
        const double za = l * (static_cast<double>(i) / kStations - 0.5),
                     zb = l * (static_cast<double>(i + 1) / kStations - 0.5);
        const double ta = upper(za), tb = upper(zb);
        const double half = half_width(spec, (za + zb) / 2 + z0, std::max(ta, tb));
        const auto under = [&](double z, double t) {
            return half < spec.size_m.x / 2 ? spec.clearance_m
                                            : std::min(t, underside(spec, z + z0));
        };
        const double ua = under(za, ta), ub = under(zb, tb);
        const auto at = [&](double side, double y, double z) {
            return dvec3(side * half, y, z + z0);
        };
        add_quad(mesh, {at(-1, ta, za), at(-1, tb, zb), at(1, tb, zb), at(1, ta, za)});
        add_quad(mesh, {at(-1, ua, za), at(1, ua, za), at(1, ub, zb), at(-1, ub, zb)});
        add_quad(mesh, {at(-1, ua, za), at(-1, ub, zb), at(-1, tb, zb), at(-1, ta, za)});
        add_quad(mesh, {at(1, ua, za), at(1, ta, za), at(1, tb, zb), at(1, ub, zb)});
        // Front and back of a station show at the ends, and where the next one is narrower.
        const auto other = [&](int step) {
            return half_width(spec, (za + zb) / 2 + step * (zb - za) + z0, std::max(ta, tb));
        };
        if (i == 0 || other(-1) < half)
            add_quad(mesh, {at(-1, ua, za), at(-1, ta, za), at(1, ta, za), at(1, ua, za)});
        if (i == kStations - 1 || other(1) < half)
            add_quad(mesh, {at(-1, ub, zb), at(1, ub, zb), at(1, tb, zb), at(-1, tb, zb)});
    }
    return mesh;
}

scene::Mesh roof_mesh(const VehicleSpec& spec) {
    const double low = spec.clearance_m, h = spec.size_m.y, l = spec.size_m.z,
                 half = spec.size_m.x / 2, z0 = middle_of(spec);
    const double belt = low + kBelt * h, roof = low + h, thick = 0.05, bar = 0.06;
    const double front = -0.04 * l + z0, rear = 0.3 * l + z0, inner = 0.84 * half;
    const dvec3 middle(0, roof - thick / 2, (front + rear) / 2);
    scene::Mesh mesh;
    for (const double y : {roof - thick, roof})
        add_outward(mesh, middle,
                    {{-inner, y, front}, {-inner, y, rear}, {inner, y, rear}, {inner, y, front}});
    for (const double side : {-1.0, 1.0}) {
        const double x = side * inner;
        add_outward(
            mesh, middle,
            {{x, roof - thick, front}, {x, roof - thick, rear}, {x, roof, rear}, {x, roof, front}});
        const double foot = side * (half - bar / 2), head = side * (inner - bar / 2),
                     under = roof - thick;
        add_pillar(mesh, {foot, belt, -0.18 * l + z0}, {head, under, front}, bar);
        add_pillar(mesh, {foot, belt, 0.12 * l + z0}, {head, under, 0.12 * l + z0}, bar);
        add_pillar(mesh, {foot, belt, 0.42 * l + z0}, {head, under, rear}, bar);
    }
    for (const double z : {front, rear})
        add_outward(mesh, middle,
                    {{-inner, roof - thick, z},
                     {inner, roof - thick, z},
                     {inner, roof, z},
                     {-inner, roof, z}});
    return mesh;
}

scene::Mesh wheel_mesh(const AxleSpec& axle) {
    scene::Mesh mesh;
    const double half = axle.width_m / 2, rim = 0.62 * axle.radius_m;
    const auto at = [&](int spoke, double radius, double x) {
        const double turn = 2 * glm::pi<double>() * spoke / kSpokes;
        return dvec3(x, radius * std::cos(turn), radius * std::sin(turn));
    };
    for (int i = 0; i < kSpokes; ++i) {
        add_outward(mesh, dvec3(0),
                    {at(i, axle.radius_m, -half), at(i + 1, axle.radius_m, -half),
                     at(i + 1, axle.radius_m, half), at(i, axle.radius_m, half)});
        for (const double side : {-1.0, 1.0}) {
            add_outward(mesh, dvec3(0),
                        {at(i, rim, side * half), at(i + 1, rim, side * half),
                         at(i + 1, axle.radius_m, side * half), at(i, axle.radius_m, side * half)});
            // The disc lies in, and every other piece of it deeper: one sees that it turns.
            const double in = side * half * (i % 4 < 2 ? 0.7 : 0.3);
            add_outward(mesh, dvec3(0),
                        {{in, 0, 0}, at(i, rim, in), at(i + 1, rim, in), {in, 1e-4, 0}});
        }
    }
    return mesh;
}

} // namespace sward::drive
