// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "assets/layer_image.h"
#include "texgen/seam/seam.h"

namespace sward::texgen {

/// Pictures of one size and kind, from the ground up: what `IN` of `texgen seam` names.
struct LayerStack {
    std::vector<std::filesystem::path> files;
    std::vector<assets::LayerImage> images;
};

/// `input`: a directory (the layers of its stack.json, else its PNG, TIFF and EXR files, by name
/// with numbers in order), a pattern ("layer.%04d.png", from the least number that exists on,
/// without gaps), or one picture. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] LayerStack read_stack(const std::filesystem::path& input);

/// Joint of the stack on the torus, gradients summed over its pictures (a sparse one alone has
/// columns without any change): the worse of both axes.
[[nodiscard]] JointReport measure_stack(const LayerStack& stack);

/// G2 on all pictures alike: one pair of boundaries for the stack, so that blades that cross layers
/// stay whole. The texel with the larger alpha (else the larger luminance) wins whole.
[[nodiscard]] LayerStack seam_stack(const LayerStack& stack, const SeamCut& cut);

} // namespace sward::texgen
