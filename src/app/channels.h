// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sward/camera.h"

namespace sward::app {

/// One of several pictures of a moment: a screen of a cockpit, an eye of two, a mirror.
struct Channel {
    std::string name;
    glm::ivec2 size{0}; ///< pixels
    glm::ivec2 at{0};   ///< of its upper left corner in the window, pixels
    /// From the middle's eye, in that eye's own axes: position is (right, up, back), yaw 0 looks
    /// ahead. Its lens is not used.
    CameraPose turn;
    Tangents rim;
};

/// The channels of a TOML file, at least one; docs/simulator.md has its keys. Throws Error: kIo,
/// kBadInput, kOverLimit.
[[nodiscard]] std::vector<Channel> read_channels(const std::filesystem::path& file);

/// What a channel sees of a moment whose middle is seen by `middle`, whose own lens does not count.
[[nodiscard]] Camera channel_camera(const Camera& middle, const Channel& channel);

/// Of the window that holds them all, pixels.
[[nodiscard]] glm::ivec2 extent_of(const std::vector<Channel>& channels);

/// A channel's picture beside the others': "out.png" becomes "out-left.png".
[[nodiscard]] std::filesystem::path channel_file(const std::filesystem::path& file,
                                                 const Channel& channel);

} // namespace sward::app
