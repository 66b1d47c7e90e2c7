// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/view_state.h"

namespace sward::app {

/// Writes the frame just drawn under `path`, by its extension: the display picture, or linear
/// channels (`aovs`; empty: the colour). Throws Error(kIo).
void capture(const render::ViewState& view, const std::filesystem::path& path,
             const std::vector<std::string>& aovs);

/// Writes the frame just drawn as the next free sward-NNNN picture in the working directory; never
/// over an older one. Returns its name. Throws Error(kIo).
[[nodiscard]] std::filesystem::path capture_screenshot(const render::ViewState& view);

/// Pictures one after another, in the next free folder sward-seq-NNNN of the working directory.
class PictureSequence {
public:
    /// Makes the folder. Throws Error(kIo).
    PictureSequence();
    /// Writes the frame just drawn as the next, from 00000 on. Throws Error(kIo).
    void add(const render::ViewState& view);
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] int count() const { return count_; }

private:
    std::filesystem::path folder_;
    int count_ = 0;
};

} // namespace sward::app
