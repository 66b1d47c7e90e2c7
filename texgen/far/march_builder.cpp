// SPDX-License-Identifier: Apache-2.0
#include "texgen/far/march_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "shared/blade.h"
#include "shared/march.h"
#include "shared/shading.h"
#include "texgen/patch/canopy.h"

namespace sward::texgen {
namespace {

constexpr int kRows = grass::kMarchRows;
constexpr int kColumnSide = shared::kMarchTexels >> shared::kColumnBase;

MarchImages images_of(int width, int height, int layers) {
    MarchImages images{width, height, layers, {}};
    images.mips.emplace_back(
        static_cast<std::size_t>(width) * height * layers * MarchImages::kFloats, 0.0f);
    return images;
}

/// Halves width and height (down to 1), each texel the mean of its children.
std::vector<float> halved(const std::vector<float>& from, int width, int height, int layers) {
    const int w = std::max(1, width / 2), h = std::max(1, height / 2), sx = width > 1 ? 2 : 1,
              sy = height > 1 ? 2 : 1;
    std::vector<float> out(static_cast<std::size_t>(w) * h * layers * MarchImages::kFloats, 0.0f);
    for (int n = 0; n < layers; ++n)
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int j = 0; j < sy; ++j)
                    for (int i = 0; i < sx; ++i) {
                        const float* a =
                            &from[((static_cast<std::size_t>(n) * height + y * sy + j) * width +
                                   x * sx + i) *
                                  MarchImages::kFloats];
                        float* b = &out[((static_cast<std::size_t>(n) * h + y) * w + x) *
                                        MarchImages::kFloats];
                        for (std::size_t c = 0; c < MarchImages::kFloats; ++c)
                            b[c] += a[c] / static_cast<float>(sx * sy);
                    }
    return out;
}

void make_mips(MarchImages& images) {
    for (int m = 0; (images.width >> m) > 1 || (images.height >> m) > 1; ++m)
        images.mips.push_back(halved(images.mips.back(), std::max(1, images.width >> m),
                                     std::max(1, images.height >> m), images.layers));
}

/// Texels of a mip whose mean density is to be 1: `runs` of `length` texels each, `stride` apart
/// from `first`.
struct Height {
    std::size_t first, runs, stride, length;
};

void divide_by_mean(std::vector<float>& mip, const Height& height) {
    constexpr std::size_t kFloats = MarchImages::kFloats;
    double sum = 0;
    for (std::size_t run = 0; run < height.runs; ++run)
        for (std::size_t i = 0; i < height.length; ++i)
            sum += mip[(height.first + run * height.stride + i) * kFloats + MarchImages::kDensity];
    const double scale = sum > 0 ? static_cast<double>(height.runs * height.length) / sum : 0.0;
    for (std::size_t run = 0; run < height.runs; ++run)
        for (std::size_t i = 0; i < height.length * kFloats; ++i) {
            float& value = mip[(height.first + run * height.stride) * kFloats + i];
            value = static_cast<float>(value * scale);
        }
}

/// The next coarser set: two slabs become one, texels twice as wide. Not taller: a coarse pixel
/// still tells the heads from the leaves.
MarchImages coarser(const MarchImages& fine) {
    MarchImages out = images_of(fine.width / 2, fine.height, fine.layers / 2);
    constexpr std::size_t kFloats = MarchImages::kFloats;
    const std::size_t image = static_cast<std::size_t>(fine.width) * fine.height * kFloats;
    for (int n = 0; n < out.layers; ++n)
        for (std::size_t i = 0; i < image / 2; ++i) {
            const std::size_t left = 2 * (i / kFloats) * kFloats + i % kFloats;
            for (const std::size_t slab : {2 * n * image, (2 * n + 1) * image})
                out.mips[0][n * image / 2 + i] +=
                    0.25f * (fine.mips[0][slab + left] + fine.mips[0][slab + left + kFloats]);
        }
    return out;
}

grass::TextureArray packed(const MarchImages& images) {
    grass::TextureArray array{
        images.width, images.height, images.layers, {}, grass::TexelFormat::kRgba16f};
    for (const std::vector<float>& mip : images.mips) {
        std::vector<std::uint8_t> bytes(mip.size());
        for (std::size_t i = 0; i < mip.size(); ++i) {
            if (i % MarchImages::kFloats > MarchImages::kDensity)
                continue;
            const std::uint16_t half = glm::packHalf1x16(std::min(mip[i], 60000.0f));
            std::memcpy(&bytes[8 * (i / MarchImages::kFloats) + 2 * (i % MarchImages::kFloats)],
                        &half, 2);
        }
        array.mips.push_back(std::move(bytes));
    }
    return array;
}

grass::TextureArray packed_fibres(const MarchImages& images) {
    grass::TextureArray array{images.width, images.height, images.layers, {}};
    for (const std::vector<float>& mip : images.mips) {
        std::vector<std::uint8_t> bytes(mip.size() / 2);
        for (std::size_t i = 0; i < mip.size(); i += MarchImages::kFloats) {
            const float density = mip[i + MarchImages::kDensity];
            const float* sum = &mip[i + MarchImages::kDensity + 1];
            const glm::vec4 mean = density > 0 ? glm::vec4(sum[0], sum[1], sum[2], sum[3]) / density
                                               : glm::vec4(0, 1, 0, 0.5f);
            const glm::vec4 coded(0.5f + 0.5f * mean.x, mean.y, 0.5f + 0.5f * mean.z, mean.w);
            for (int c = 0; c < 4; ++c)
                bytes[i / 2 + static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(255 * std::clamp(coded[c], 0.0f, 1.0f)));
        }
        array.mips.push_back(std::move(bytes));
    }
    return array;
}

/// Area as it counts where rays go mostly along these shares of the axes.
double area_seen(const glm::dvec3& area, const glm::dvec3& way) {
    return glm::length(area * way);
}
const glm::dvec3 kColumnWay(0.5, 0.6, 0.5), kLevelWay(0.7, 0.05, 0.7), kSteepWay(0, 1, 0);
const glm::dvec3 kSlabWays[2] = {{0.87, 0.45, 0.2}, {0.2, 0.45, 0.87}};

void add_piece(MarchImages& images, std::size_t texel, const SurfacePiece& piece, double area) {
    float* out = &images.mips[0][texel * MarchImages::kFloats];
    const auto weight = static_cast<float>(area);
    for (int c = 0; c < 3; ++c) {
        out[c] += piece.albedo[c] * weight;
        out[MarchImages::kDensity + 1 + static_cast<std::size_t>(c)] += piece.tangent[c] * weight;
    }
    out[MarchImages::kDensity] += weight;
    out[MarchImages::kDensity + 4] += piece.rank * weight;
}

/// Mean albedo over another.
glm::vec4 tint_of(const glm::dvec4& seen, const glm::dvec4& held) {
    glm::vec4 tint(1, 1, 1, 0);
    for (int c = 0; c < 3 && seen.w > 0 && held[c] > 0; ++c)
        tint[c] = static_cast<float>(std::clamp(seen[c] / seen.w / (held[c] / held.w), 0.2, 5.0));
    return tint;
}

} // namespace

MarchBuilder::MarchBuilder(double side_m, double canopy_m, int variants,
                           std::span<const double> seen)
    : side_(side_m), canopy_(canopy_m), variants_(variants),
      columns_(images_of(kColumnSide, kColumnSide, variants * shared::kMarchLayers)),
      slabs_(images_of(shared::kMarchTexels, kRows, variants * 2 * shared::kFinestSlabs)) {
    edges_[shared::kMarchLayers] = canopy_m;
    for (int i = shared::kMarchLayers - 1; i > 0; --i) {
        const double share = static_cast<double>(i) / shared::kMarchLayers;
        const double even = canopy_m * share;
        const double met =
            seen.empty() ? even
                         : seen[static_cast<std::size_t>(share * static_cast<double>(seen.size()))];
        edges_[i] = std::clamp(0.85 * met + 0.15 * even, canopy_m * i / 200,
                               edges_[i + 1] - canopy_m / 200);
    }
}

void MarchBuilder::add(int variant, const SurfacePiece& piece) {
    const auto cell = [](double share, int count) {
        return std::clamp(static_cast<int>(share * count), 0, count - 1);
    };
    const double x = piece.place.x / side_ - std::floor(piece.place.x / side_),
                 z = piece.place.z / side_ - std::floor(piece.place.z / side_);
    const double y = std::clamp(piece.place.y, 0.0, canopy_);
    const double area = area_seen(piece.area, kColumnWay);
    const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, y);
    const auto layer = static_cast<int>(above - edges_.begin()) - 1;
    areas_[layer] += piece.area;
    moments_[layer] += glm::length(piece.area) * glm::dvec3(1, piece.tangent.y, piece.along);
    const glm::dvec4 albedo(glm::dvec3(piece.albedo), 1);
    tints_[layer].columns += area * albedo;
    tints_[layer].level += area_seen(piece.area, kLevelWay) * albedo;
    tints_[layer].steep += area_seen(piece.area, kSteepWay) * albedo;
    species_.resize(std::max(species_.size(), piece.species + 1), 0.0);
    species_[piece.species] += area * y;
    add_piece(columns_,
              (static_cast<std::size_t>(variant * shared::kMarchLayers + layer) * kColumnSide +
               cell(z, kColumnSide)) *
                      kColumnSide +
                  cell(x, kColumnSide),
              piece, area);
    for (const int axis : {shared::kAxisX, shared::kAxisZ}) {
        const int slab = cell(axis == shared::kAxisX ? x : z, shared::kFinestSlabs);
        const auto image =
            static_cast<std::size_t>((variant * 2 + axis) * shared::kFinestSlabs + slab);
        add_piece(slabs_,
                  (image * kRows + cell(y / canopy_, kRows)) * shared::kMarchTexels +
                      cell(axis == shared::kAxisX ? z : x, shared::kMarchTexels),
                  piece, area_seen(piece.area, kSlabWays[axis]));
    }
}

MarchData MarchBuilder::finish(std::span<const shared::GrassAppearance> looks) {
    MarchData data;
    data.columns = std::move(columns_);
    data.slabs[0] = std::move(slabs_);
    for (int k = 1; k < shared::kMarchSets; ++k)
        data.slabs[k] = coarser(data.slabs[k - 1]);
    make_mips(data.columns);
    const auto variants = static_cast<std::size_t>(variants_);
    for (std::size_t m = 0; m < data.columns.mips.size();
         ++m) { // a layer's mean is over its own images
        const auto image = static_cast<std::size_t>(std::max(1, kColumnSide >> m)) *
                           static_cast<std::size_t>(std::max(1, kColumnSide >> m));
        for (std::size_t layer = 0; layer < shared::kMarchLayers; ++layer)
            divide_by_mean(data.columns.mips[m],
                           {layer * image, variants, shared::kMarchLayers * image, image});
    }
    for (MarchImages& set : data.slabs) {
        make_mips(set);
        for (std::size_t m = 0; m < set.mips.size(); ++m) { // a row's over all slabs
            const auto width = static_cast<std::size_t>(std::max(1, set.width >> m)),
                       height = static_cast<std::size_t>(std::max(1, set.height >> m));
            for (std::size_t row = 0; row < height; ++row)
                divide_by_mean(set.mips[m], {row * width, static_cast<std::size_t>(set.layers),
                                             height * width, width});
        }
    }
    const double ground = side_ * side_ * variants_;
    glm::dvec3 above(0);
    data.medium.edges[shared::kMarchLayers] = {0, 0, 0, static_cast<float>(canopy_)};
    for (int i = shared::kMarchLayers - 1; i >= 0; --i) {
        above += areas_[i] / ground;
        data.medium.edges[i] = glm::vec4(glm::vec3(above), static_cast<float>(edges_[i]));
        const double area = std::max(moments_[i].x, 1e-12);
        data.medium.layers[i] = {static_cast<float>(moments_[i].y / area),
                                 static_cast<float>(moments_[i].z / area), 0, 0};
        data.medium.level_tint[i] = tint_of(tints_[i].level, tints_[i].columns);
        data.medium.steep_tint[i] = tint_of(tints_[i].steep, tints_[i].columns);
    }
    double whole = 0, translucency = 0;
    glm::dvec4 gloss(0);
    for (std::size_t s = 0; s < species_.size() && s < looks.size(); ++s) {
        whole += species_[s];
        const shared::GrassGloss& own = looks[s].gloss;
        gloss += species_[s] *
                 glm::dvec4(own.diffuse, own.diffuse_power, own.specular, own.specular_power);
        translucency += species_[s] * static_cast<double>(looks[s].translucency);
    }
    const glm::vec4 mean(gloss / std::max(whole, 1e-12));
    data.medium.gloss = {mean.x, mean.y, mean.z, mean.w};
    data.medium.side_m = static_cast<float>(side_);
    data.medium.canopy_m = static_cast<float>(canopy_);
    data.medium.translucency = static_cast<float>(translucency / std::max(whole, 1e-12));
    data.medium.variants = static_cast<int>(variants_);
    shared::fill_views(data.medium);
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
            const double length = glm::length(along);
            const glm::vec3 tangent(length > 0 ? along / length * (along.y < 0 ? -1.0 : 1.0)
                                               : glm::dvec3(0, 1, 0));
            const int pieces = std::max(1, static_cast<int>(std::ceil(length / fine)));
            for (int n = 0; n < pieces; ++n) {
                const double t = (n + 0.5) / pieces, v = outline.between(i, t);
                const double half = std::lerp(outline.half[i], outline.half[i + 1], t);
                const int across = std::max(1, static_cast<int>(std::ceil(2 * half / fine)));
                const glm::vec3 albedo = shared::blade_albedo(look, {blade.root.z, blade.root.w},
                                                              static_cast<float>(v), 1);
                for (int w = 0; w < across; ++w) {
                    const double aside = half * (2 * (w + 0.5) / across - 1);
                    builder.add(variant, {outline.centre[i] + t * along + aside * outline.across,
                                          normal * (2 * half / across / pieces), albedo, tangent,
                                          blade.root.z, v, species_of(blade)});
                }
            }
        }
    }
}

grass::FarMedium pack_march(const MarchData& data) {
    grass::FarMedium out;
    out.medium = data.medium;
    out.columns = {packed(data.columns), packed_fibres(data.columns)};
    for (int k = 0; k < shared::kMarchSets; ++k)
        out.slabs[k] = {packed(data.slabs[k]), packed_fibres(data.slabs[k])};
    return out;
}

} // namespace sward::texgen
