// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "grass/far_light.h"
#include "shared/blade.h"
#include "shared/grass_layout.h"
#include "shared/march_medium.h"

namespace sward::grass {

enum class TexelFormat {
    kRgba8,     ///< UNORM, 4 bytes a texel
    kRgba32f,   ///< 16 bytes a texel
    kRgba16f,   ///< 8 bytes a texel
    kBc5,       ///< two channels UNORM in blocks of 4 x 4 texels, 16 bytes a block
    kRgba8Srgb, ///< as kRgba8, with sRGB in RGB and linear alpha: colour for other engines, never
                ///< part of a set
};

/// Texture array with mips, the content of a KTX2 file. Mip m is max(1, width >> m) x max(1, height
/// >> m) x layers texels, layer-major, row-major; of blocks where the format has some, those at the
/// rim filled up.
struct TextureArray {
    int width = 0;
    int height = 0;
    int layers = 0;
    std::vector<std::vector<std::uint8_t>> mips;
    TexelFormat format = TexelFormat::kRgba8;
    bool plain =
        false; ///< one 2D texture, not an array of one: what other engines take for an atlas
};

/// One level of the far tier: level k has texels 2^k as wide as level 0's and about half the layers
/// and slices of level k - 1, each image showing the blades of its whole (thicker) slab. Indices:
/// shaders/shared/grass_layout.h.
struct FarLevel {
    int layer_count = 0; ///< shells; layer i is the slab layer_edges[i] .. layer_edges[i + 1]
    std::vector<float> layer_edges; ///< metres above the ground, rising from 0 to the canopy's top;
                                    ///< layer_count + 1
    std::vector<float> layer_heights; ///< where each is drawn, within its slab; layer_count
    int slice_count =
        0; ///< per axis and patch side; slice i is the slab [i, i + 1] * side / slice_count
    TextureArray layers; ///< variants * layer_count * 2 planes, (size >> k) square
    TextureArray slices; ///< variants * 2 axes * slice_count * 2 planes, (size >> k) x rows
    /// The shape planes as BC5, where the set keeps them so (no mips otherwise): image 2 i is the
    /// tangent of image i, 2 i + 1 its root offset. `layers` and `slices` then hold what these
    /// decode to.
    TextureArray layers_shape = {};
    TextureArray slices_shape = {};
};

/// The whole canopy seen from far away, by view elevation: what rays through the blades meet, and
/// how the flat textures have to be shown to meet as much.
struct FarRow {
    float elevation_deg = 90;
    float coverage = 0; ///< share of rays that meet a blade before the ground
    float height = 0;   ///< mean height of the hits, 0 ground .. 1 top of the canopy
    float along = 0;    ///< mean place along the blade of the hits, 0 root .. 1 tip
    /// Share of the shells' blades shown at this view elevation, so that shells and slices of level
    /// 0 together cover what the blades cover: a shell shows a blade while 1 - seed < shell_share
    /// (the slices use the other end of the seeds first). Linear in elevation between rows. Above
    /// 1, up to kMaxShellShare: all of them, and their texels' coverage times so much, where thick
    /// slabs have lost what the blades' sides cover.
    float shell_share = 1;
    /// Share of the slices' |dx| and |dz| at this elevation: from above they show as rows, and the
    /// shells suffice.
    float slice_share = 1;
    std::vector<float>
        coarse_shares; ///< the same for levels 1, 2, ...: thicker slabs need more of the shells

    [[nodiscard]] float share_at(int level) const {
        return level == 0 ? shell_share : coarse_shares[static_cast<std::size_t>(level - 1)];
    }
};

inline constexpr double kMaxShellShare = 8;

/// Images of the march: averages of the blades' surface, which mips go on averaging.
struct MarchArrays {
    TextureArray density; ///< a: area of blades in the texel over the mean of its height; rgb:
                          ///< their albedo times that
    TextureArray fibres;  ///< mean tangent x, y, z as t * 0.5 + 0.5 (y: as it is); mean rank
};

/// What the far field's march reads (docs/far-field.md).
struct FarMedium {
    shared::MarchMedium medium{};
    MarchArrays columns; ///< variants * kMarchLayers; u along x, v along z
    /// Set k: variants * 2 axes * (kFinestSlabs >> k); u along the slab, v up from the ground to
    /// the canopy's top.
    std::array<MarchArrays, shared::kMarchSets> slabs;
    /// Kinds x half mips x elevations x (factor on the optical depth, on the light, for each of
    /// kMarchDensities), the last fastest.
    std::vector<float> correction;
};
inline constexpr int kMarchRows = 48; ///< of a slab
inline constexpr std::array<double, 2> kMarchDensities = {1.0, 0.4};
inline constexpr int kMarchKinds = shared::kMarchSets + 1; ///< the sets of slabs, the columns
inline constexpr std::size_t kMarchFactors = 2 * kMarchDensities.size();
inline constexpr std::size_t kMarchCorrections =
    kMarchKinds * shared::kMarchMips * shared::kMarchElevations * kMarchFactors;

/// One of the set's kinds of blades.
struct Species {
    std::string name;
    std::string element; ///< blade, seed_head, leaf, flower: what `look.outline` draws
    float share = 1;     ///< of the set's blades; all add up to 1
    shared::GrassAppearance look{};
};

/// What covers the soil under the blades: moss and short leaves, and litter.
struct Floor {
    float cover = 0;     ///< share of the soil that it hides, 0..1
    glm::vec3 moss{0};   ///< linear reflectance
    glm::vec3 litter{0}; ///< likewise
};

/// A grass set in memory: what texgen writes and the renderer reads (docs/texgen.md).
struct GrassSet {
    std::string name;
    std::uint64_t seed = 0;
    float side_m = 2;         ///< the patch tiles the plane with this period
    float canopy_m = 0;       ///< top of the volume above the ground
    float offset_range_m = 0; ///< range of the root offsets in the shape plane
    int variants = 0;         ///< agree along their edges: any may stand beside any
    float density_per_m2 = 0; ///< blades
    int height_coding =
        shared::kHeightNone; ///< else the layers of a level are one height map a variant (B1)
    std::vector<shared::BladeRecord> blades;  ///< variant-major; inside a variant by rising rank
    std::vector<std::uint32_t> variant_begin; ///< variants + 1 offsets into blades
    std::vector<FarLevel> levels;             ///< at least 1
    FarMedium march;                          ///< what the far field is drawn from
    std::vector<FarRow> far;                  ///< falling elevation
    FarLight far_light;                       ///< its light, at the same elevations
    Floor floor;                              ///< none where a set names none
    std::vector<Species>
        species; ///< 1 to shared::kMaxSpecies; a blade's shape.w and a texel's A name one
};

/// Images of a level's layers that a variant has, planes not counted.
[[nodiscard]] inline int layer_images(const GrassSet& set, const FarLevel& level) {
    return set.height_coding == shared::kHeightNone ? level.layer_count : 1;
}

/// Array index of the image that layer `layer` is drawn from.
[[nodiscard]] inline int layer_image(const GrassSet& set, const FarLevel& level, int variant,
                                     int layer, int plane) {
    const int images = layer_images(set, level);
    return shared::layer_index(variant, images == 1 ? 0 : layer, images, plane);
}

/// Reads a set's directory. Every file's SHA-256 is checked against set.json before it is parsed
/// (volume.vdb is not read). Throws Error: kIo missing, kBadInput damaged or of another format
/// version, kOverLimit.
[[nodiscard]] GrassSet read_grass_set(const std::filesystem::path& directory);

/// One file of a set's directory, after its size and SHA-256 have been compared with set.json.
/// Throws likewise.
[[nodiscard]] std::vector<std::byte> read_set_file(const std::filesystem::path& directory,
                                                   const std::string& name);

} // namespace sward::grass
