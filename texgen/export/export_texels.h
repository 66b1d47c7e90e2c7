// SPDX-License-Identifier: Apache-2.0
// The images of level 0 of a set's layers and slices, decoded: what every export of textures starts
// from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grass/grass_set.h"
#include "shared/types.h"

namespace sward::texgen {

inline constexpr const char* kVariantPrefix = "variant";

/// One image of the set, and what it is called.
struct ImageSource {
    std::string name; ///< "variant0_layer03"
    const grass::TextureArray* array = nullptr;
    int id_index = 0, shape_index = 0;
    int variant = 0;
    bool slice = false;
    int axis = 0;       ///< of a slice: shared::kAxisX, kAxisZ
    double place_m = 0; ///< a layer's height above the ground; a slice's middle along its axis
    double from_m = 0, to_m = 0; ///< the slab whose blades it shows
};

/// Variant by variant: layers from the ground up, slices across x, slices across z.
[[nodiscard]] std::vector<ImageSource> image_sources(const grass::GrassSet& set);

/// What one texel says, as numbers; all 0 where nothing stands.
struct TexelValues {
    double coverage = 0;
    shared::vec3 albedo{0}, tangent{0}; ///< linear reflectance; unit
    double rank = 0, seed = 0, along = 0, height = 0;
    shared::vec2 offset{0}; ///< metres to the blade's root, x and z
    int species = 0;
};

class TexelDecoder {
public:
    explicit TexelDecoder(const grass::GrassSet& set) : set_(set) {}

    /// Row 0 at the top of the picture: a slice's ground is at its bottom.
    [[nodiscard]] TexelValues texel(const ImageSource& source, int x, int row) const;

private:
    const grass::GrassSet& set_;
};

/// 8-bit code of a number in [0, 1], clamped.
[[nodiscard]] std::uint8_t byte_of(double value);
/// sRGB's transfer function.
[[nodiscard]] double srgb(double linear);

} // namespace sward::texgen
