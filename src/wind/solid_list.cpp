// SPDX-License-Identifier: Apache-2.0
#include "wind/solid_list.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"

namespace sward::wind {
namespace {

using shared::WindSolid;
using Kind = scene::WindObstacle::Kind;

} // namespace

SolidList::SolidList(const scene::Scene& scene, const Meshes& meshes)
    : obstacles_(scene.wind.obstacles), paths_(scene.paths), cell_m_(scene.wind.cell_m) {
    std::map<std::pair<std::filesystem::path, double>, std::size_t>
        known; // a herd of one mesh has one footprint
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        const scene::WindObstacle& obstacle = obstacles_[i];
        print_of_.push_back(0);
        if (obstacle.kind != Kind::kMesh)
            continue;
        const auto [entry, fresh] =
            known.emplace(std::pair(obstacle.mesh, obstacle.height_m), prints_.size());
        print_of_.back() = entry->second;
        if (!fresh)
            continue;
        const auto mesh = meshes.find(obstacle.mesh);
        const auto refuse = [&](const char* key, const std::string& found,
                                const std::string& expected) {
            return base::input_error(base::ExitCode::kBadInput, scene.file, 0,
                                     fmt::format("wind.obstacle[{}].{}", i, key), found, expected);
        };
        if (mesh == meshes.end())
            throw refuse("mesh", base::printable(obstacle.mesh.native()),
                         "a mesh that the host has loaded");
        const Footprint print = footprint_of(mesh->second, obstacle.height_m, cell_m_);
        if (print.words.empty()) {
            float low = mesh->second.positions.front().y, high = low;
            for (const glm::vec3& position : mesh->second.positions)
                low = std::min(low, position.y), high = std::max(high, position.y);
            throw refuse(
                "height_m", fmt::format("{}", obstacle.height_m),
                fmt::format("a height that meets the mesh, between {} and {} m", low, high));
        }
        prints_.push_back({words_.size(), print.corner_m, print.bit_m, print.width, print.height});
        words_.insert(words_.end(), print.words.begin(), print.words.end());
    }
}

std::vector<WindSolid> SolidList::at(double time_s, glm::dvec2 origin) const {
    std::vector<WindSolid> solids;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        const scene::WindObstacle& obstacle = obstacles_[i];
        const Carried carried = carried_at(obstacle.where, paths_, time_s);
        WindSolid solid{};
        solid.place = glm::vec2(carried.place - origin);
        solid.heading = glm::vec2(base::Heading(carried.yaw_deg).right());
        solid.velocity = glm::vec2(carried.velocity);
        solid.turn_rad_s = static_cast<float>(carried.turn_rad_s);
        if (obstacle.kind == Kind::kMesh) {
            const Print& print = prints_[print_of_[i]];
            solid.corner = print.corner_m;
            solid.bit_m = static_cast<float>(print.bit_m);
            solid.first_word = static_cast<int>(print.first_word);
            solid.bits = {print.width, print.height};
            solid.kind = shared::kSolidFootprint;
        } else if (obstacle.kind == Kind::kBox) {
            const glm::dvec2 half = glm::max(0.5 * obstacle.size, glm::dvec2(0.5 * cell_m_));
            solid.half_size = glm::vec2(half);
            solid.kind = shared::kSolidBox;
        } else {
            // A cell's half diagonal: wherever it stands, a centre is inside.
            solid.half_size =
                glm::vec2(static_cast<float>(std::max(obstacle.size.x, 0.7072 * cell_m_)));
            solid.kind = shared::kSolidCircle;
        }
        solids.push_back(solid);
    }
    return solids;
}

glm::vec4 solid_bounds(const WindSolid& solid) {
    const glm::vec2 place = solid.place, right = solid.heading,
                    back(-solid.heading.y, solid.heading.x);
    glm::vec2 least = -solid.half_size, most = solid.half_size;
    if (solid.kind == shared::kSolidCircle)
        return {place - solid.half_size.x, place + solid.half_size.x};
    if (solid.kind == shared::kSolidFootprint) {
        least = solid.corner;
        most = least + glm::vec2(solid.bits) * solid.bit_m;
    }
    const glm::vec2 middle =
        place + right * (0.5f * (least.x + most.x)) + back * (0.5f * (least.y + most.y));
    const glm::vec2 half = glm::abs(right) * (0.5f * (most.x - least.x)) +
                           glm::abs(back) * (0.5f * (most.y - least.y));
    return {middle - half, middle + half};
}

bool covers(const WindSolid& solid, glm::vec2 xz, const std::vector<std::uint32_t>& words) {
    const glm::vec2 own = shared::solid_frame(solid, xz);
    if (solid.kind != shared::kSolidFootprint)
        return shared::solid_covers(solid, own);
    const int bit = shared::solid_bit(solid, own);
    return bit >= 0 &&
           (words[static_cast<std::size_t>(solid.first_word + bit / 32)] >> (bit % 32) & 1U) != 0;
}

} // namespace sward::wind
