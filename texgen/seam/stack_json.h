// SPDX-License-Identifier: Apache-2.0
// stack.json: where the pictures of a layer stack lie (docs/texgen.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sward::texgen {

inline constexpr const char* kStackJson = "stack.json";

/// A picture seen from above.
struct StackLayer {
    std::string file;               ///< in the stack's directory
    std::optional<double> height_m; ///< above the ground
};

/// What is not known stays empty.
struct StackDescription {
    std::string name; ///< of the set or preset
    std::optional<double> side_m, canopy_m;
    std::vector<StackLayer> layers; ///< by rising height
};

/// DIR/stack.json, or nothing where there is none. Reads what `texgen seam` and `texgen PRESET
/// --export png` write: of several variants the first, and of slices nothing. Throws base::Error:
/// kBadInput, kOverLimit.
[[nodiscard]] std::optional<StackDescription>
read_stack_json(const std::filesystem::path& directory);

[[nodiscard]] std::string stack_json_text(const StackDescription& stack);

} // namespace sward::texgen
