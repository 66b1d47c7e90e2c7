// SPDX-License-Identifier: Apache-2.0
#include "app/pose_source.h"

#include <fmt/format.h>

#include "app/controls.h"
#include "app/drive_source.h"
#include "app/feed_source.h"
#include "app/fly_source.h"
#include "app/helicopter_source.h"

namespace sward::app {
namespace {

/// The free camera. It flies by the clock, so that one can look around while time stands.
class FreeFlight : public PoseSource {
public:
    void advance(ViewPose& pose, const PoseMoment& moment) override {
        controls_.step(pose.pose, moment.input, moment.real_s);
        keep_above_ground(pose.pose,
                          moment.land.height(pose.pose.position.x, pose.pose.position.z));
        pose.roll_deg = 0;
    }
    [[nodiscard]] bool in_real_time() const override { return true; }
    [[nodiscard]] std::string note() const override {
        return fmt::format("set {:.3g} m/s", controls_.speed_mps());
    }

private:
    FlyControls controls_;
};

std::unique_ptr<PoseSource> source_of(const fly::AircraftSpec& aircraft) {
    if (const auto* const helicopter = std::get_if<fly::HelicopterSpec>(&aircraft))
        return make_helicopter_source(*helicopter);
    return make_fly_source(std::get<fly::AeroplaneSpec>(aircraft));
}

} // namespace

std::unique_ptr<PoseSource> make_pose_source(const Options& options, const SourceParts& parts) {
    std::unique_ptr<PoseSource> source;
    if (parts.links.in)
        source = make_feed_source(parts.links.in, parts.on_earth);
    else if (!options.drive.empty())
        source = make_drive_source(find_vehicle(options.drive), options.tyres, parts.cover);
    else if (!options.fly.empty())
        source = source_of(find_aircraft(options.fly));
    else
        source = std::make_unique<FreeFlight>();
    if (parts.links.out)
        source = with_report(std::move(source), parts.links.out, parts.cover);
    return source;
}

} // namespace sward::app
