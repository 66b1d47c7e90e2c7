// SPDX-License-Identifier: Apache-2.0
#include "texgen/march_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "shared/blade.h"
#include "shared/shading.h"
#include "texgen/canopy.h"

namespace sward::texgen {
namespace {

constexpr int kRows = grass::kMarchRows;
constexpr int kColumnSide = shared::kMarchTexels >> shared::kColumnBase;

MarchImages images_of(int width, int height, int layers) {
    MarchImages images{width, height, layers, {}};
    images.mips.emplace_back(static_cast<std::size_t>(width) * height * layers * 4, 0.0f);
    return images;
}

/// Halves width and height (down to 1), each texel the mean of its children.
std::vector<float> halved(const std::vector<float>& from, int width, int height, int layers) {
    const int w = std::max(1, width / 2), h = std::max(1, height / 2), sx = width > 1 ? 2 : 1, sy = height > 1 ? 2 : 1;
    std::vector<float> out(static_cast<std::size_t>(w) * h * layers * 4, 0.0f);
    for (int n = 0; n < layers; ++n)
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int j = 0; j < sy; ++j)
                    for (int i = 0; i < sx; ++i) {
                        const float* a = &from[((static_cast<std::size_t>(n) * height + y * sy + j) * width + x * sx + i) * 4];
                        float* b = &out[((static_cast<std::size_t>(n) * h + y) * w + x) * 4];
                        for (int c = 0; c < 4; ++c)
                            b[c] += a[c] / static_cast<float>(sx * sy);
                    }
    return out;
}

void make_mips(MarchImages& images) {
    for (int m = 0; (images.width >> m) > 1 || (images.height >> m) > 1; ++m)
        images.mips.push_back(halved(images.mips.back(), std::max(1, images.width >> m), std::max(1, images.height >> m), images.layers));
}

/// Divides each texel of a mip by the mean area of its row, over all images of `stride` numbers apart.
void divide_rows(std::vector<float>& mip, int width, int height, int layers) {
    for (int y = 0; y < height; ++y) {
        double sum = 0;
        for (int n = 0; n < layers; ++n)
            for (int x = 0; x < width; ++x)
                sum += mip[((static_cast<std::size_t>(n) * height + y) * width + x) * 4 + 3];
        const double scale = sum > 0 ? static_cast<double>(width) * layers / sum : 0.0;
        for (int n = 0; n < layers; ++n)
            for (int x = 0; x < width * 4; ++x) {
                float& value = mip[(static_cast<std::size_t>(n) * height + y) * width * 4 + x];
                value = static_cast<float>(value * scale);
            }
    }
}

/// The next coarser set: two slabs become one, texels twice as wide. Not taller: a coarse pixel still tells the heads from the leaves.
MarchImages coarser(const MarchImages& fine) {
    MarchImages out = images_of(fine.width / 2, fine.height, fine.layers / 2);
    const std::size_t image = static_cast<std::size_t>(fine.width) * fine.height * 4;
    for (int n = 0; n < out.layers; ++n)
        for (std::size_t i = 0; i < image / 2; ++i) {
            const std::size_t texel = i / 4, left = (2 * texel) * 4 + i % 4;
            for (const std::size_t slab : {2 * n * image, (2 * n + 1) * image})
                out.mips[0][n * image / 2 + i] += 0.25f * (fine.mips[0][slab + left] + fine.mips[0][slab + left + 4]);
        }
    return out;
}

grass::TextureArray packed(const MarchImages& images) {
    grass::TextureArray array{images.width, images.height, images.layers, {}, grass::TexelFormat::kRgba16f};
    for (const std::vector<float>& mip : images.mips) {
        std::vector<std::uint8_t> bytes(mip.size() * 2);
        for (std::size_t i = 0; i < mip.size(); ++i) {
            const std::uint16_t half = glm::packHalf1x16(std::min(mip[i], 60000.0f));
            std::memcpy(&bytes[2 * i], &half, 2);
        }
        array.mips.push_back(std::move(bytes));
    }
    return array;
}

} // namespace

MarchBuilder::MarchBuilder(double side_m, double canopy_m, int variants, std::span<const double> seen)
    : side_(side_m), canopy_(canopy_m), variants_(variants), columns_(images_of(kColumnSide, kColumnSide, variants * shared::kMarchLayers)),
      slabs_(images_of(shared::kMarchTexels, kRows, variants * 2 * shared::kFinestSlabs)) {
    edges_[shared::kMarchLayers] = canopy_m;
    for (int i = shared::kMarchLayers - 1; i > 0; --i) {
        const double share = static_cast<double>(i) / shared::kMarchLayers;
        const double even = canopy_m * share;
        const double met = seen.empty() ? even : seen[static_cast<std::size_t>(share * static_cast<double>(seen.size()))];
        edges_[i] = std::clamp(0.85 * met + 0.15 * even, canopy_m * i / 200, edges_[i + 1] - canopy_m / 200);
    }
}

void MarchBuilder::add_to(MarchImages& images, std::size_t texel, const SurfacePiece& piece, double area) const {
    float* out = &images.mips[0][texel * 4];
    for (int c = 0; c < 3; ++c)
        out[c] += piece.albedo[c] * static_cast<float>(area);
    out[3] += static_cast<float>(area);
}

void MarchBuilder::add(int variant, const SurfacePiece& piece) {
    const auto cell = [](double share, int count) { return std::clamp(static_cast<int>(share * count), 0, count - 1); };
    const double x = piece.place.x / side_ - std::floor(piece.place.x / side_), z = piece.place.z / side_ - std::floor(piece.place.z / side_);
    const double y = std::clamp(piece.place.y, 0.0, canopy_);
    const double area = glm::length(piece.area);
    const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, y);
    const auto layer = static_cast<int>(above - edges_.begin()) - 1;
    areas_[layer] += piece.area;
    moments_[layer] += area * glm::dvec3(1, piece.upright, piece.along);
    species_.resize(std::max(species_.size(), piece.species + 1), 0.0);
    species_[piece.species] += area * y;
    add_to(columns_, (static_cast<std::size_t>(variant * shared::kMarchLayers + layer) * kColumnSide + cell(z, kColumnSide)) * kColumnSide + cell(x, kColumnSide),
           piece, area);
    for (const int axis : {shared::kAxisX, shared::kAxisZ}) {
        const int slab = cell(axis == shared::kAxisX ? x : z, shared::kFinestSlabs);
        const auto image = static_cast<std::size_t>((variant * 2 + axis) * shared::kFinestSlabs + slab);
        add_to(slabs_, (image * kRows + cell(y / canopy_, kRows)) * shared::kMarchTexels + cell(axis == shared::kAxisX ? z : x, shared::kMarchTexels),
               piece, area);
    }
}

MarchData MarchBuilder::finish(std::span<const shared::GrassAppearance> looks) {
    MarchData data;
    data.columns = std::move(columns_);
    data.slabs[0] = std::move(slabs_);
    for (int k = 1; k < shared::kMarchSets; ++k)
        data.slabs[k] = coarser(data.slabs[k - 1]);
    make_mips(data.columns);
    const std::size_t column_texels = static_cast<std::size_t>(variants_);
    for (std::size_t m = 0; m < data.columns.mips.size(); ++m) { // a layer's mean is over its own images
        const int side = std::max(1, kColumnSide >> m);
        for (int layer = 0; layer < shared::kMarchLayers; ++layer) {
            double sum = 0;
            const std::size_t image = static_cast<std::size_t>(side) * side * 4;
            const auto first = [&](std::size_t v) { return (v * shared::kMarchLayers + layer) * image; };
            for (std::size_t v = 0; v < column_texels; ++v)
                for (std::size_t i = 3; i < image; i += 4)
                    sum += data.columns.mips[m][first(v) + i];
            const double scale = sum > 0 ? static_cast<double>(side) * side * variants_ / sum : 0.0;
            for (std::size_t v = 0; v < column_texels; ++v)
                for (std::size_t i = 0; i < image; ++i)
                    data.columns.mips[m][first(v) + i] = static_cast<float>(data.columns.mips[m][first(v) + i] * scale);
        }
    }
    for (MarchImages& set : data.slabs) {
        make_mips(set);
        for (std::size_t m = 0; m < set.mips.size(); ++m)
            divide_rows(set.mips[m], std::max(1, set.width >> m), std::max(1, set.height >> m), set.layers);
    }
    const double ground = side_ * side_ * variants_;
    glm::dvec3 above(0);
    data.medium.edges[shared::kMarchLayers] = {0, 0, 0, static_cast<float>(canopy_)};
    for (int i = shared::kMarchLayers - 1; i >= 0; --i) {
        above += areas_[i] / ground;
        data.medium.edges[i] = glm::vec4(glm::vec3(above), static_cast<float>(edges_[i]));
        const double area = std::max(moments_[i].x, 1e-12);
        data.medium.layers[i] = {static_cast<float>(moments_[i].y / area), static_cast<float>(moments_[i].z / area), 0, 0};
    }
    double whole = 0, translucency = 0;
    glm::dvec4 look(0);
    for (std::size_t s = 0; s < species_.size() && s < looks.size(); ++s) {
        whole += species_[s];
        look += species_[s] * glm::dvec4(looks[s].light);
        translucency += species_[s] * static_cast<double>(looks[s].dry.w);
    }
    data.medium.look = glm::vec4(look / std::max(whole, 1e-12));
    data.medium.size = {static_cast<float>(side_), static_cast<float>(canopy_), static_cast<float>(translucency / std::max(whole, 1e-12)),
                        static_cast<float>(variants_)};
    return data;
}

void add_blades(const Patch& patch, int variant, MarchBuilder& builder) {
    const double fine = 0.4 * patch.side_m / shared::kMarchTexels;
    for (const shared::BladeRecord& blade : patch.variant(variant)) {
        const Outline outline = outline_of(blade, patch.looks);
        const shared::GrassAppearance& look = patch.looks[species_of(blade)];
        for (int i = 0; i < Outline::kSegments; ++i) {
            const glm::dvec3 along = outline.centre[i + 1] - outline.centre[i];
            const glm::dvec3 normal = glm::abs(glm::cross(along, outline.across)); // per width
            const double length = glm::length(along), upright = length > 0 ? along.y * along.y / (length * length) : 1.0;
            const int pieces = std::max(1, static_cast<int>(std::ceil(length / fine)));
            for (int n = 0; n < pieces; ++n) {
                const double t = (n + 0.5) / pieces, v = outline.between(i, t);
                const double half = std::lerp(outline.half[i], outline.half[i + 1], t);
                const int across = std::max(1, static_cast<int>(std::ceil(2 * half / fine)));
                const glm::vec3 albedo = shared::blade_albedo(look, {blade.root.z, blade.root.w}, static_cast<float>(v), 1);
                for (int w = 0; w < across; ++w) {
                    const double aside = half * (2 * (w + 0.5) / across - 1);
                    builder.add(variant, {outline.centre[i] + t * along + aside * outline.across, normal * (2 * half / across / pieces), albedo, upright, v,
                                          species_of(blade)});
                }
            }
        }
    }
}

grass::FarMedium pack_march(const MarchData& data) {
    grass::FarMedium out;
    out.medium = data.medium;
    out.columns = packed(data.columns);
    for (int k = 0; k < shared::kMarchSets; ++k)
        out.slabs[k] = packed(data.slabs[k]);
    return out;
}

} // namespace sward::texgen
