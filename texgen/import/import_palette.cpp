// SPDX-License-Identifier: Apache-2.0
#include "texgen/import/import_palette.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "texgen/preset/preset.h"

namespace sward::texgen {
namespace {

constexpr int kSteps = 32,
              kPlaces =
                  4; // of a channel and of the place along the strand, for bins of like voxels
constexpr double kApart = 0.15;      // of coded colours: more than one species' variation explains
constexpr double kLeastShare = 2e-4; // of the area: what is rarer is the rim of something else
constexpr int kMostRounds = 12;

/// Roughly as far apart as eyes find colours to be.
glm::dvec3 coded(const glm::dvec3& linear) {
    return glm::sqrt(glm::max(linear, glm::dvec3(0)));
}

/// Voxels of like colour at like places along their strands.
struct Bin {
    double weight = 0;
    glm::dvec3 colour{0}; ///< mean
    double along = 0;
    std::size_t line = 0;
};

/// Colour over the place along the strand, by least squares.
struct Line {
    double w = 0, v = 0, vv = 0;
    glm::dvec3 c{0}, cv{0}, root{0}, tip{0};

    void add(double weight, double along, const glm::dvec3& colour) {
        w += weight;
        v += weight * along;
        vv += weight * along * along;
        c += weight * colour;
        cv += weight * along * colour;
    }
    void fit() {
        const double spread = w * vv - v * v;
        const glm::dvec3 slope = spread > 1e-3 * w * w ? (w * cv - v * c) / spread : glm::dvec3(0);
        root = glm::clamp((c - slope * v) / w, 0.0, 1.0);
        tip = glm::clamp((c - slope * v) / w + slope, 0.0, 1.0);
    }
    [[nodiscard]] glm::dvec3 at(double along) const { return glm::mix(root, tip, along); }
};

std::size_t bin_of(const VoxelField& field, std::size_t i) {
    const glm::dvec3 colour = coded(field.colour(i));
    std::size_t index =
        static_cast<std::size_t>(std::clamp(field.along(i) * kPlaces, 0.0f, kPlaces - 1.0f));
    for (int channel = 0; channel < 3; ++channel)
        index = index * kSteps +
                static_cast<std::size_t>(std::clamp(colour[channel] * kSteps, 0.0, kSteps - 1.0));
    return index;
}

double apart(const Bin& bin, const Line& line) {
    return glm::length(coded(bin.colour) - coded(line.at(bin.along)));
}

/// Every bin to its nearest line, and the lines to their bins, until nothing changes.
void settle(std::vector<Bin*>& bins, std::vector<Line>& lines) {
    for (int round = 0; round < kMostRounds; ++round) {
        bool changed = round == 0;
        for (Bin* bin : bins) {
            std::size_t best = 0;
            for (std::size_t k = 1; k < lines.size(); ++k)
                if (apart(*bin, lines[k]) < apart(*bin, lines[best]))
                    best = k;
            changed |= best != bin->line;
            bin->line = best;
        }
        if (!changed)
            return;
        std::vector<Line> next(lines.size());
        for (const Bin* bin : bins)
            next[bin->line].add(bin->weight, bin->along, bin->colour);
        for (std::size_t k = 0; k < lines.size(); ++k)
            if (next[k].w > 0) { // one that lost all its bins stays where it was
                next[k].fit();
                lines[k] = next[k];
            } else {
                lines[k].w = 0;
            }
    }
}

/// Lines until every bin that counts is near one.
std::vector<Line> find_lines(std::vector<Bin*>& bins, double all) {
    std::vector<Line> lines(1);
    for (const Bin* bin : bins)
        lines[0].add(bin->weight, bin->along, bin->colour);
    lines[0].fit();
    while (lines.size() < static_cast<std::size_t>(shared::kMaxSpecies)) {
        const Bin* farthest = nullptr;
        for (const Bin* bin : bins)
            if (bin->weight > kLeastShare * all &&
                (!farthest ||
                 apart(*bin, lines[bin->line]) > apart(*farthest, lines[farthest->line])))
                farthest = bin;
        if (!farthest || apart(*farthest, lines[farthest->line]) < kApart)
            break;
        lines.emplace_back();
        lines.back().add(farthest->weight, farthest->along, farthest->colour);
        lines.back().fit();
        settle(bins, lines);
    }
    return lines;
}

/// The look of a line, with how far single voxels are from it: `error` is the mean square of their
/// value's relative distance.
shared::GrassAppearance look_of(const Line& line, double error, const Species& light) {
    shared::GrassAppearance look = appearance(light);
    // blade_albedo scales by 1 + variation * 0.7 * value, value even over one: its standard
    // deviation is 0.7 / sqrt 12.
    const double variation = std::clamp(std::sqrt(error) / (0.7 / std::sqrt(12.0)), 0.0, 1.0);
    look.root = glm::vec3(line.root);
    look.dry_share = 0; // the voxels' own mean holds dry blades
    look.tip = look.dry = glm::vec3(line.tip);
    look.variation = static_cast<float>(variation);
    return look;
}

} // namespace

Palette palette_of(const VoxelField& field) {
    Palette palette;
    if (!field.coloured()) {
        palette.species.push_back({"imported", "blade", 1, appearance(field.volume().light)});
        return palette;
    }
    std::vector<Bin> table(static_cast<std::size_t>(kPlaces) * kSteps * kSteps * kSteps);
    double all = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        Bin& bin = table[bin_of(field, i)];
        const double weight = field.density(i);
        all += weight;
        bin.weight += weight;
        bin.colour += weight * glm::dvec3(field.colour(i));
        bin.along += weight * field.along(i);
    }
    std::vector<Bin*> bins;
    for (Bin& bin : table)
        if (bin.weight > 0) {
            bin.colour /= bin.weight;
            bin.along /= bin.weight;
            bins.push_back(&bin);
        }
    const std::vector<Line> lines = find_lines(bins, all);

    std::vector<double> errors(lines.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        const std::size_t k = table[bin_of(field, i)].line;
        const glm::dvec3 mean = lines[k].at(field.along(i)), found(field.colour(i));
        const double expected = mean.x + mean.y + mean.z;
        const double off = expected > 1e-6 ? (found.x + found.y + found.z) / expected - 1 : 0;
        errors[k] += field.density(i) * off * off;
    }
    std::vector<std::size_t> order(lines.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t k) { return !(lines[k].w > 0); });
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t k) { return lines[k].w; });
    std::vector<std::uint8_t> number(lines.size());
    for (std::size_t n = 0; n < order.size(); ++n) {
        const Line& line = lines[order[n]];
        number[order[n]] = static_cast<std::uint8_t>(n);
        palette.species.push_back(
            {n == 0 ? std::string("imported") : fmt::format("imported{}", n + 1), "blade",
             static_cast<float>(line.w / all),
             look_of(line, errors[order[n]] / line.w, field.volume().light)});
    }
    if (order.size() > 1) {
        palette.of_voxel.reserve(field.size());
        for (std::size_t i = 0; i < field.size(); ++i)
            palette.of_voxel.push_back(number[table[bin_of(field, i)].line]);
    }
    return palette;
}

} // namespace sward::texgen
