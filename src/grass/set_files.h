// SPDX-License-Identifier: Apache-2.0
// Names inside a grass set's directory, known to its writer and its reader.
#pragma once

#include <cstdint>
#include <string>

namespace sward::grass {

/// Raised whenever sets of the same preset change, in form or in content: belongs in the key of
/// every cache of sets, and the reader refuses every other.
inline constexpr int kSetFormatVersion = 15;
inline constexpr int kMaxVariants = 16;
inline constexpr int kMaxFarLevels =
    4; // as shared::kMaxFarLevels: the renderer has room for so many
inline constexpr std::uint64_t kMaxSetJsonBytes = 1 << 20;
inline constexpr const char* kSetJson = "set.json";
inline constexpr const char* kBladesFile = "blades.glb";
inline constexpr const char* kFarLightFile = "far.ktx2";
inline constexpr const char* kFarLightPicture = "far.exr"; // the same for tools
inline constexpr const char* kVolumeFile = "volume.vdb";
inline constexpr const char* kPreviewFile = "preview.png";

inline constexpr const char* kColumnsFile = "columns.ktx2";
inline constexpr const char* kColumnFibresFile = "column_fibres.ktx2";
inline constexpr const char* kCorrectionFile = "correction.ktx2";

/// slabs.ktx2, slabs_1.ktx2, slabs_2.ktx2
[[nodiscard]] std::string slabs_file(int set);
[[nodiscard]] std::string slab_fibres_file(int set);
/// layers.ktx2, layers_1.ktx2, ...
[[nodiscard]] std::string layers_file(int level);
[[nodiscard]] std::string slices_file(int level);
/// layers_shape.ktx2, layers_shape_1.ktx2, ...: beside the two above where a set keeps its shape
/// planes as BC5.
[[nodiscard]] std::string layers_shape_file(int level);
[[nodiscard]] std::string slices_shape_file(int level);

} // namespace sward::grass
