// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <tiny_gltf.h>

namespace sward::assets {

/// Parses a .glb or .gltf and the buffers that it names; pictures are left alone. The file counts
/// as hostile: nesting is counted before a recursive parser sees the text, and a buffer's URI must
/// lead to a plain file in the glTF's own directory or below, not through `..`, a link or a scheme.
/// Indices inside are not checked here. Throws base::Error.
[[nodiscard]] tinygltf::Model read_gltf(const std::filesystem::path& path);

} // namespace sward::assets
