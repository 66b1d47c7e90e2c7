// SPDX-License-Identifier: Apache-2.0
#include "app/pose_source.h"

#include <fmt/format.h>

#include "app/controls.h"
#include "app/drive_source.h"

namespace sward::app {
namespace {

/// The free camera. It flies by the clock, so that one can look around while time stands.
class FreeFlight : public PoseSource {
public:
    void advance(ViewPose& pose, const PoseMoment& moment) override {
        controls_.step(pose.pose, moment.input, moment.real_s);
        keep_above_ground(pose.pose, moment.land.height(pose.pose.position.x, pose.pose.position.z));
        pose.roll_deg = 0;
    }
    [[nodiscard]] bool in_real_time() const override { return true; }
    [[nodiscard]] std::string note() const override { return fmt::format("set {:.3g} m/s", controls_.speed_ms()); }

private:
    FlyControls controls_;
};

} // namespace

std::unique_ptr<PoseSource> make_pose_source(const Options& options, const scene::PlaceOnEarth&) {
    if (!options.drive.empty())
        return make_drive_source(find_vehicle(options.drive), options.tyres);
    return std::make_unique<FreeFlight>();
}

} // namespace sward::app
