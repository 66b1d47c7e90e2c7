// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "app/options.h"
#include "feed/udp_socket.h"

namespace sward::app {

/// The sockets that the options ask for; they stay open from scene to scene.
struct FeedLinks {
    std::shared_ptr<feed::UdpReceiver> in; ///< --native-fdm; null: none
    std::shared_ptr<feed::UdpSender> out;  ///< --udp-out; null: none
};
/// Opens them before anything that takes long. Throws Error(kIo).
[[nodiscard]] FeedLinks open_feed(const Options& options);

} // namespace sward::app
