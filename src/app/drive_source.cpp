// SPDX-License-Identifier: Apache-2.0
#include "app/drive_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "app/controls.h"
#include "app/model_eye.h"
#include "app/model_files.h"
#include "app/paths.h"
#include "app/turn_angles.h"
#include "base/angles.h"
#include "drive/vehicle.h"
#include "drive/vehicle_mesh.h"
#include "render/world.h"

namespace sward::app {
namespace {

constexpr double kChaseBack = 1.4, kChaseUp_m = 1.5; // of the vehicle's length; over its roof
constexpr double kChaseFollow_per_s = 4;             // how fast the chase camera comes round
constexpr double kChasePitch_deg = -9;
constexpr double kWakeFrom_mps = 2; // slower, no blade feels its wake
constexpr double kWakeRadii = 40;   // how long that is
constexpr std::array<const char*, 3> kCameras = {"driver", "chase", "wheel"};

/// Keys drive as they are held; a wheel and its pedals as far as they are turned and pressed. A
/// brake pedal brakes and does not drive back.
drive::Pedals pedals_of(const Input& asked) {
    using input::Axis;
    return {std::clamp(asked.move.z + asked.axis(Axis::kThrottle), -1.0, 1.0),
            std::clamp(asked.move.x + asked.axis(Axis::kSteer), -1.0, 1.0),
            asked.hand_brake ? 1.0 : std::max({0.0, asked.move.y, asked.axis(Axis::kBrake)})};
}

class DriveSource : public PoseSource {
public:
    DriveSource(drive::VehicleSpec spec, std::optional<drive::Surface> tyres, CoverAt cover)
        : spec_(std::move(spec)), tyres_(tyres), cover_(std::move(cover)) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        if (!vehicle_) // the land is the same for all of a flight
            vehicle_.emplace(spec_, drive::DriveLand{moment.land.height, [this, land = moment.land](
                                                                             double x, double z) {
                                                         return surface_at(land, {x, z});
                                                     }});
        if (!told_ || *told_ != pose.pose.position) { // a camera's key, or the beginning
            vehicle_->put(pose.pose.position.x, pose.pose.position.z, pose.pose.yaw_deg);
            eye_.begin(pose.pose.yaw_deg);
        }
        for (const Press& press : moment.input.presses)
            if (press.action == Action::kDriveCamera) {
                camera_ = (camera_ + 1) % kCameras.size();
                eye_.look_ahead();
            }
        vehicle_->advance(moment.dt_s, pedals_of(moment.input));
        eye_.look_aside(moment.input.look_px);
        place_eye(pose, moment);
        told_ = pose.pose.position;
    }

    [[nodiscard]] std::optional<double> speed_mps() const override {
        return vehicle_ ? std::optional(glm::length(vehicle_->state().velocity_mps)) : std::nullopt;
    }
    [[nodiscard]] std::string note() const override {
        return fmt::format("{} on {}, {} camera", spec_.name, ground_name(), kCameras[camera_]);
    }

    /// Wheels, and the body over them.
    [[nodiscard]] std::vector<Ball> bodies() const override {
        std::vector<Ball> balls;
        if (!vehicle_)
            return balls;
        const drive::VehicleState state = vehicle_->state();
        for (std::size_t i = 0; i < 4; ++i) {
            const double radius = spec_.axles[i / 2].radius_m;
            balls.push_back(
                {state.wheels[i].contact + state.turn * glm::dvec3(0, radius, 0), radius});
        }
        const double radius = std::min({spec_.size_m.x, spec_.size_m.y, spec_.size_m.z}) / 2;
        const int rows = std::max(1, static_cast<int>(std::floor(spec_.size_m.z / (1.5 * radius))));
        for (int row = 0; row < rows; ++row)
            for (const double side : {-1.0, 1.0}) {
                const double z = rows == 1 ? 0
                                           : (static_cast<double>(row) / (rows - 1) - 0.5) *
                                                 (spec_.size_m.z - 2 * radius);
                const glm::dvec3 at(side * std::max(0.0, spec_.size_m.x / 2 - radius),
                                    spec_.clearance_m + radius, z);
                balls.push_back({state.position + state.turn * at, radius});
            }
        return balls;
    }

    /// The air that it drags along.
    [[nodiscard]] std::vector<Blower> blowers() const override {
        if (!vehicle_)
            return {};
        const drive::VehicleState state = vehicle_->state();
        const glm::dvec2 over(state.velocity_mps.x, state.velocity_mps.z);
        const double speed = glm::length(over);
        if (speed < kWakeFrom_mps)
            return {};
        Blower blower;
        blower.kind = Blower::Kind::kWake;
        const glm::dvec3 ahead = state.ahead();
        const double side = glm::dot(over, glm::dvec2(ahead.x, ahead.z)) < 0 ? -1 : 1;
        const glm::dvec3 end = state.position - ahead * (side * spec_.size_m.z / 2);
        blower.place = {end.x, end.z};
        blower.velocity = over;
        blower.yaw_deg = std::atan2(over.x, -over.y) / base::kDegree;
        blower.speed_mps = std::min(speed, 300.0);
        // As wide as a disc of that drag is.
        blower.radius_m = std::max(0.3, std::sqrt(spec_.drag_m2 / glm::pi<double>()));
        blower.length_m = kWakeRadii * blower.radius_m;
        return {blower};
    }

    void add_objects(render::World& world) override {
        first_ = world.scene.objects.size();
        const glm::dvec3 paint(0.32, 0.03, 0.03), roof(0.05), rubber(0.03);
        const auto add = [&](const char* name, const scene::Mesh& mesh, const glm::dvec3& colour) {
            add_model_mesh(world, name, mesh, colour);
        };
        add("vehicle/body", drive::body_mesh(spec_), paint);
        add("vehicle/roof", drive::roof_mesh(spec_), roof);
        for (std::size_t i = 0; i < 4; ++i)
            add(i < 2 ? "vehicle/front wheel" : "vehicle/rear wheel",
                drive::wheel_mesh(spec_.axles[i / 2]), rubber);
    }

    [[nodiscard]] std::vector<Body> objects() const override {
        std::vector<Body> bodies;
        if (!vehicle_)
            return bodies;
        const auto add = [&](const glm::dvec3& at, const glm::dquat& turn) {
            bodies.push_back(
                {first_ + bodies.size(), glm::translate(glm::dmat4(1), at) * glm::mat4_cast(turn)});
        };
        const drive::VehicleState state = vehicle_->state();
        add(state.position, state.turn);
        add(state.position, state.turn);
        for (const drive::WheelState& wheel : state.wheels)
            add(wheel.hub, wheel.turn);
        return bodies;
    }

private:
    [[nodiscard]] drive::Surface surface_at(const Land& land, glm::dvec2 place) const {
        using drive::Surface;
        if (tyres_ && *tyres_ != Surface::kWetGrass)
            return *tyres_;
        const Surface there = drive::surface_of(cover_(place, glm::vec3(normal_at(land, place))));
        return tyres_ && there == Surface::kGrass ? Surface::kWetGrass : there;
    }

    /// Of its left wheels, and of its right ones where those stand on something else.
    [[nodiscard]] std::string ground_name() const {
        if (!vehicle_)
            return "its wheels";
        const auto wheels = vehicle_->state().wheels;
        const std::size_t left = static_cast<std::size_t>(wheels[0].surface),
                          right = static_cast<std::size_t>(wheels[1].surface);
        return left == right ? drive::kSurfaceNames[left]
                             : fmt::format("{} and {}", drive::kSurfaceNames[left],
                                           drive::kSurfaceNames[right]);
    }

    void place_eye(ViewPose& view, const PoseMoment& moment) {
        const drive::VehicleState state = vehicle_->state();
        Angles sight = angles_of(state.turn);
        glm::dvec3 at = state.position + state.turn * spec_.eye_m;
        if (camera_ == 1) {
            const ModelEye::Chase chase{kChaseBack * spec_.size_m.z, spec_.size_m.y + kChaseUp_m,
                                        kChaseFollow_per_s, kChasePitch_deg};
            eye_.come_round(sight.yaw, chase, moment.dt_s);
            return eye_.put_behind(view, state.position, chase, moment.land);
        }
        if (camera_ == 2) { // beside the front wheel, towards it
            const drive::AxleSpec& axle = spec_.axles[0];
            at = state.position + state.turn * glm::dvec3(axle.track_m / 2 + 1.2,
                                                          axle.radius_m + 0.5, -axle.ahead_m + 1.2);
            sight.yaw -= 45;
            sight.pitch -= 18;
        }
        eye_.put_on_board(view, at, sight, moment.land);
    }

    drive::VehicleSpec spec_;
    std::optional<drive::Surface> tyres_;
    CoverAt cover_;
    std::optional<drive::Vehicle> vehicle_;
    std::optional<glm::dvec3> told_; ///< where the eye was put last
    std::size_t camera_ = 0;
    std::size_t first_ = 0; ///< of its objects in the scene
    ModelEye eye_;
};

} // namespace

drive::VehicleSpec find_vehicle(const std::string& name) {
    return drive::load_vehicle(find_model("--drive", vehicles_directory(), name));
}

std::unique_ptr<PoseSource> make_drive_source(const drive::VehicleSpec& spec,
                                              std::optional<drive::Surface> tyres, CoverAt cover) {
    return std::make_unique<DriveSource>(spec, tyres, std::move(cover));
}

} // namespace sward::app
