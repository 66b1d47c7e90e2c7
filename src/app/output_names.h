// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "app/options.h"
#include "scene/scene.h"

namespace sward::app {

/// Names of the pictures of a run: one name, or for a sequence a name with the frame's number in
/// the place of %d or %04d.
class OutputNames {
public:
    /// Throws Error(kUsage) when a sequence's name has no such place, or more than one.
    explicit OutputNames(const Options& options);
    [[nodiscard]] std::filesystem::path name(int frame) const;

private:
    std::string before_, after_;
    int digits_ = -1; ///< -1: a single picture
};

/// Refuses what cannot end well before any work is done: an output of an unknown kind, AOVs in a
/// display picture, a name that cannot be written. Throws Error: kUsage, kIo.
void check_outputs(const Options& options);
/// Like base::require_writable, but the directory may be missing where it can be made. Throws
/// Error(kIo).
void require_place(const std::filesystem::path& path);
/// Makes the directory that a file is to stand in, and those above it. Throws Error(kIo).
void make_parent(const std::filesystem::path& path);
/// Refuses an output that is one of the scene's own files. Throws Error(kUsage).
void check_not_inputs(const Options& options, const scene::Scene& scene);

} // namespace sward::app
