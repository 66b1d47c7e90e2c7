// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/feed_links.h"
#include "app/flow_overlay.h"
#include "app/land_cover.h"
#include "app/options.h"
#include "app/view_pose.h"
#include "app/window.h"
#include "scene/scene.h"
#include "sward/field.h"

namespace sward::render {
struct World;
} // namespace sward::render

namespace sward::app {

/// What a pose source is told once a picture.
struct PoseMoment {
    const Input& input; ///< keys, mouse and gamepad since the call before
    double real_s = 0;  ///< by the clock since the call before; at most a quarter of a second,
                        ///< however long a picture took
    double time_s = 0;  ///< simulated, of the picture that is drawn next
    double dt_s = 0;    ///< simulated since the call before; 0 while time stands
    const Land& land;   ///< ground and wind
};

/// What moves the eye: the keyboard, a vehicle, a recording, another program. The viewer asks it
/// once a picture, before it simulates.
class PoseSource {
public:
    virtual ~PoseSource() = default;
    /// Takes `pose` on from where it stood after the call before (cameras on keys and a new scene
    /// put it elsewhere meanwhile).
    virtual void advance(ViewPose& pose, const PoseMoment& moment) = 0;
    /// Whether it moves by the clock, even while time stands: its speed is then by the clock too.
    [[nodiscard]] virtual bool in_real_time() const { return false; }
    /// What pushes the grass aside as it moves, where it stands now; of the same number from
    /// picture to picture. None: nothing.
    [[nodiscard]] virtual std::vector<Ball> bodies() const { return {}; }
    /// What moves the air as it goes, where it is now. None: nothing.
    [[nodiscard]] virtual std::vector<Blower> blowers() const { return {}; }
    /// Adds what it shows of itself to a scene, before a field is made of it.
    virtual void add_objects(render::World&) {}
    /// Where those stand now.
    [[nodiscard]] virtual std::vector<Body> objects() const { return {}; }
    /// How fast what moves goes, where the eye changes its place on it; none: as the eye goes.
    [[nodiscard]] virtual std::optional<double> speed_mps() const { return {}; }
    /// A few words for the line on the picture ("set 5 m/s", "stream stands since 3 s"); empty:
    /// none.
    [[nodiscard]] virtual std::string note() const { return {}; }
};

/// What a source may be made of beside the options.
struct SourceParts {
    FeedLinks links;              ///< open_feed()
    scene::PlaceOnEarth on_earth; ///< null where the terrain has no place on Earth
    CoverAt cover;                ///< cover_of(), where `links.out` stands or something drives
};
/// The source that the options name: the one place where it is chosen. Throws Error.
[[nodiscard]] std::unique_ptr<PoseSource> make_pose_source(const Options& options,
                                                           const SourceParts& parts);

} // namespace sward::app
