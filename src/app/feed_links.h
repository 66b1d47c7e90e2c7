// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "app/options.h"
#include "feed/udp_socket.h"
#include "render/world.h"

namespace sward::app {

/// The sockets that the options ask for; they stay open from scene to scene.
struct FeedLinks {
    std::shared_ptr<feed::UdpReceiver> in; ///< --native-fdm; null: none
    std::shared_ptr<feed::UdpSender> out;  ///< --udp-out; null: none
};
/// Opens them before anything that takes long. Throws Error(kIo).
[[nodiscard]] FeedLinks open_feed(const Options& options);

/// Share of the blades that could stand at world x, z, 0 to 1, on ground of this normal; NaN where
/// the scene does not say.
using GrassShare = std::function<double(glm::dvec2 place, glm::vec3 normal)>;
/// Keeps what it needs of a world that is to be given away, the mask in bytes.
[[nodiscard]] GrassShare grass_share_of(const render::World& world);

} // namespace sward::app
