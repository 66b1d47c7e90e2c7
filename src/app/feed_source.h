// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "app/feed_links.h"
#include "app/land_cover.h"
#include "app/pose_source.h"

namespace sward::app {

/// An aircraft that another program flies. Throws Error(kUsage) where the terrain has no place on
/// Earth.
[[nodiscard]] std::unique_ptr<PoseSource> make_feed_source(std::shared_ptr<feed::UdpReceiver> in,
                                                           const scene::PlaceOnEarth& on_earth);
/// The same source, that tells the other program once a picture what lies under it.
[[nodiscard]] std::unique_ptr<PoseSource> with_report(std::unique_ptr<PoseSource> source,
                                                      std::shared_ptr<feed::UdpSender> out,
                                                      CoverAt cover);

} // namespace sward::app
