// SPDX-License-Identifier: Apache-2.0
#include "texgen/import/import_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/angles.h"
#include "base/hash.h"
#include "texgen/patch/canopy.h"

namespace sward::texgen {
namespace {

constexpr std::size_t kIds = 65536; // a rank and a seed
constexpr float kOpaque =
    0.999f; // a cloud's voxel lets some light through, so that powers of it exist
constexpr double kFacingSpread =
    40 * base::kDegree; // as patch.cpp turns blades about the way they bend

std::uint8_t byte_of(float unit) {
    return static_cast<std::uint8_t>(std::clamp(static_cast<int>(unit * 256), 0, 255));
}

/// Low-discrepancy over a grid of places: the generalised golden ratios of two and three
/// dimensions, so that rank and seed are each spread evenly, and over each other.
double spread(int x, int z, double a, double b) {
    const double v = x * a + z * b;
    return v - std::floor(v);
}

int wrap(int i, int n) {
    const int r = i % n;
    return r < 0 ? r + n : r;
}

} // namespace

VoxelIndex::VoxelIndex(const Volume& volume) : cells_(volume.cells) {
    const std::uint64_t total = cell(0, cells_.y, 0);
    bits_.assign(total / 64 + 1, 0);
    count_.assign(bits_.size(), 0);
    for (const VoxelPlace& p : volume.at) {
        const std::uint64_t c = cell(p.x, p.y, p.z);
        bits_[c / 64] |= std::uint64_t{1} << (c % 64);
    }
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
        count_[i] = sum;
        sum += static_cast<std::uint32_t>(std::popcount(bits_[i]));
    }
}

std::uint32_t VoxelIndex::before(int x, int y, int z) const {
    const std::uint64_t c = cell(x, y, z);
    return count_[c / 64] + static_cast<std::uint32_t>(std::popcount(
                                bits_[c / 64] & ((std::uint64_t{1} << (c % 64)) - 1)));
}

std::int64_t VoxelIndex::at(int x, int y, int z) const {
    const std::uint64_t c = cell(x, y, z);
    if (!(bits_[c / 64] >> (c % 64) & 1))
        return -1;
    return before(x, y, z);
}

VoxelField::VoxelField(const Volume& volume, double density)
    : volume_(volume), index_(volume), density_(static_cast<float>(density)),
      blades_(!volume.preset.empty() && !volume.rank.empty() && !volume.seed.empty() &&
              !volume.tangent.empty()) {
    if (blades_)
        find_roots();
    if (volume.tangent.empty())
        find_directions();
}

void VoxelField::find_roots() {
    feet_.resize(kIds);
    tops_.assign(kIds, 0);
    std::vector<std::uint16_t> lowest(kIds, 0xFFFF);
    for (std::size_t i = 0; i < size(); ++i) { // by rising y
        const std::uint32_t id = strand(i);
        const VoxelPlace& p = volume_.at[i];
        tops_[id] = std::max(tops_[id], p.y);
        lowest[id] = std::min(lowest[id], p.y);
        if (p.y == lowest[id])
            feet_[id].emplace_back((p.x + 0.5) * volume_.voxel_m, (p.z + 0.5) * volume_.voxel_m);
    }
}

void VoxelField::find_directions() {
    tangents_.resize(size());
    for (std::size_t i = 0; i < size(); ++i)
        tangents_[i] = gradient_direction(i);
}

/// Direction of least change of the density about a voxel (structure tensor of its 3 x 3 x 3
/// neighbours): along a strand the density stays as it is. Upright where nothing tells.
glm::vec3 VoxelField::gradient_direction(std::size_t i) const {
    const VoxelPlace& p = volume_.at[i];
    const auto value = [&](int x, int y, int z) {
        if (y < 0 || y >= volume_.cells.y)
            return 0.0f;
        const std::int64_t n = index_.at(wrap(x, volume_.cells.x), y, wrap(z, volume_.cells.z));
        return n < 0 ? 0.0f : volume_.density[static_cast<std::size_t>(n)];
    };
    glm::mat3 tensor(0);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
            for (int dx = -1; dx <= 1; ++dx) {
                const int x = p.x + dx, y = p.y + dy, z = p.z + dz;
                const glm::vec3 g(value(x + 1, y, z) - value(x - 1, y, z),
                                  value(x, y + 1, z) - value(x, y - 1, z),
                                  value(x, y, z + 1) - value(x, y, z - 1));
                tensor += glm::outerProduct(g, g);
            }
    const float trace = tensor[0][0] + tensor[1][1] + tensor[2][2];
    if (!(trace > 1e-6f))
        return {0, 1, 0};
    // Inverse iteration finds the eigenvector of the least eigenvalue; the shift keeps a flat place
    // upright.
    const glm::mat3 inverse = glm::inverse(tensor + glm::mat3(0.02f * trace));
    glm::vec3 t(0, 1, 0);
    for (int step = 0; step < 8; ++step)
        t = glm::normalize(inverse * t);
    return t.y < 0 ? -t : t;
}

std::uint32_t VoxelField::strand(std::size_t i) const {
    if (!volume_.rank.empty() && !volume_.seed.empty())
        return static_cast<std::uint32_t>(rank8(i)) << 8 | static_cast<std::uint32_t>(seed8(i));
    const VoxelPlace& p = volume_.at[i];
    return static_cast<std::uint32_t>(p.z) << 12 | p.x;
}

int VoxelField::rank8(std::size_t i) const {
    const VoxelPlace& p = volume_.at[i];
    return volume_.rank.empty()
               ? static_cast<int>(spread(p.x, p.z, 0.7548776662466927, 0.5698402909980532) * 256)
               : byte_of(volume_.rank[i]);
}

int VoxelField::seed8(std::size_t i) const {
    const VoxelPlace& p = volume_.at[i];
    return volume_.seed.empty()
               ? static_cast<int>(spread(p.x, p.z, 0.8191725133961645, 0.6710436067037893) * 256)
               : byte_of(volume_.seed[i]);
}

glm::vec3 VoxelField::tangent(std::size_t i) const {
    const glm::vec3 t = volume_.tangent.empty() ? tangents_[i] : volume_.tangent[i];
    return t.y < 0 ? -t : t;
}

float VoxelField::along(std::size_t i) const {
    const double top = blades_ ? tops_[strand(i)] + 1 : volume_.cells.y;
    return static_cast<float>(std::min(1.0, (volume_.at[i].y + 0.5) / top));
}

glm::dvec3 VoxelField::centre(std::size_t i) const {
    const VoxelPlace& p = volume_.at[i];
    return (glm::dvec3(p.x, p.y, p.z) + 0.5) * volume_.voxel_m;
}

glm::dvec2 VoxelField::root(std::size_t i) const {
    const glm::dvec3 c = centre(i);
    const glm::dvec2 own(c.x, c.z);
    if (!blades_)
        return own;
    glm::dvec2 best = own;
    double least = 1e30;
    for (const glm::vec2& foot : feet_[strand(i)]) {
        const glm::dvec2 offset(nearest_image(foot.x - own.x, side()),
                                nearest_image(foot.y - own.y, side()));
        if (glm::dot(offset, offset) < least) {
            least = glm::dot(offset, offset);
            best = own + offset;
        }
    }
    return best;
}

double VoxelField::farthest_root() const {
    double farthest = 0;
    if (blades_)
        for (std::size_t i = 0; i < size(); ++i) {
            const glm::dvec3 c = centre(i);
            farthest = std::max(farthest, glm::distance(root(i), glm::dvec2(c.x, c.z)));
        }
    return farthest;
}

glm::vec3 VoxelField::normal(std::size_t i, const glm::vec3& tangent_there) const {
    const glm::vec3 t = tangent(i);
    const float flat = std::hypot(t.x, t.z);
    // A blade bends over its flat side, give or take; the volume does not keep by how much, its
    // blade's number does.
    const double turn =
        (base::hash_unit(strand(i), 0, 0) * 2 - 1) * kFacingSpread + std::numbers::pi / 2;
    const double azimuth =
        (flat > 1e-4f ? std::atan2(t.z, t.x) : base::hash_unit(strand(i), 1, 0) * 6.283185307) +
        turn;
    const glm::vec3 across(std::cos(azimuth), 0, std::sin(azimuth));
    return glm::normalize(glm::cross(tangent_there, across));
}

float VoxelField::others(std::size_t i) const {
    if (!blades_ || volume_.others.empty() || !(volume_.density[i] > 0))
        return 0;
    return std::clamp(volume_.others[i] / volume_.density[i], 0.0f, 1.0f);
}

float VoxelField::seen_along(std::size_t i, const glm::vec3& direction) const {
    return blades_ ? density(i) * std::abs(glm::dot(normal(i, tangent(i)), direction))
                   : std::min(density(i), kOpaque);
}

} // namespace sward::texgen
