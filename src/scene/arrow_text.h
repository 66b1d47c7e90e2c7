// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/wind_spec.h"

namespace sward::scene {

/// The text of a scene file with `arrows` in the place of its own, by id: values that changed are
/// replaced where they stand,
/// [[wind.arrow]] blocks of arrows that are gone are cut out, new ones follow the last block. Every
/// other byte stays, comments included. `file` is for messages. Throws Error(kBadInput) when the
/// text is no TOML, or keeps its arrows in another form than [[wind.arrow]].
[[nodiscard]] std::string with_arrows(const std::string& text, const std::vector<WindArrow>& arrows,
                                      const std::filesystem::path& file);

/// Writes `arrows` into a scene file, whole or not at all, after the new text has been read back
/// and found equal. Throws Error: kIo, kBadInput.
void save_arrows(const std::filesystem::path& file, const std::vector<WindArrow>& arrows);

} // namespace sward::scene
