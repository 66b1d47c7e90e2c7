// SPDX-License-Identifier: Apache-2.0
#include "drive/vehicle.h"

#include <algorithm>
#include <cmath>

#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
#include <btBulletDynamicsCommon.h>
#include <glm/gtc/constants.hpp>

#include "base/angles.h"
#include "drive/ground_rays.h"

namespace sward::drive {
namespace {

// Bullet's own frame of a vehicle is x left, y up, z ahead; ours, x right, y up, z behind, is that
// turned by half around y.
constexpr double kGravity = 9.81, kAir = 1.2; // m/s2, kg/m3
constexpr double kFarthest_m = 128;    // from Bullet's origin: floats are 8 micrometres fine there
constexpr double kRollInfluence = 0.5; // of side forces: tyres and springs give, which rays do not
constexpr double kTurning_mps = 0.5;   // slower, the pedal that brakes drives the other way
constexpr double kParking_mps = 2;    // slower, a driver who does nothing has his foot on the brake
constexpr double kSteer_per_s = 2.5;  // of the whole lock: hands take their time
constexpr double kSteerFade_mps = 14; // at this speed half of the lock is left
constexpr double kRest_mps = 0.12, kRest_rads = 0.08, kRest_s = 0.4;
constexpr double kBodySpring = 500, kBodyDamping = 12,
                 kBodyGrip = 0.5; // of a corner on the ground, by mass
constexpr double kSunk_m = 0.3;   // a body's middle so deep has gone through
constexpr double kOverturned_s = 3;

btVector3 to_bullet(const glm::dvec3& v) {
    return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}
glm::dvec3 of_bullet(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}

bool is_finite(const btRigidBody& body) {
    const btVector3 sum =
        body.getWorldTransform().getOrigin() + body.getLinearVelocity() + body.getAngularVelocity();
    return std::isfinite(sum.x() + sum.y() + sum.z());
}

} // namespace

struct Vehicle::Inside {
    Inside(const VehicleSpec& what, DriveLand where)
        : spec(what), land(std::move(where)), rays(land.height), box(to_bullet(what.size_m * 0.5)) {
        const auto mass = static_cast<btScalar>(spec.mass_kg);
        btVector3 inertia;
        box.calculateLocalInertia(mass, inertia);
        body = std::make_unique<btRigidBody>(
            btRigidBody::btRigidBodyConstructionInfo(mass, nullptr, &box, inertia));
        body->setActivationState(DISABLE_DEACTIVATION);
        world.setGravity({0, static_cast<btScalar>(-kGravity), 0});
        world.addRigidBody(body.get());
        btRaycastVehicle::btVehicleTuning tuning;
        vehicle = std::make_unique<btRaycastVehicle>(tuning, body.get(), &rays);
        vehicle->setCoordinateSystem(0, 1, 2);
        for (std::size_t axle = 0; axle < 2; ++axle)
            add_axle(tuning, axle);
        world.addAction(vehicle.get());
    }
    ~Inside() {
        world.removeAction(vehicle.get());
        world.removeRigidBody(body.get());
    }

    void add_axle(btRaycastVehicle::btVehicleTuning& tuning, std::size_t number) {
        const AxleSpec& axle = spec.axles[number];
        const double base = spec.axles[0].ahead_m - spec.axles[1].ahead_m;
        const double share =
            std::abs(spec.axles[1 - number].ahead_m) / base / 2; // of the mass, on a wheel
        const double omega = 2 * glm::pi<double>() * axle.spring_hz;
        const double height =
            axle.radius_m + axle.travel_m - kGravity / (omega * omega) - spec.mass_height_m;
        for (const double side : {1.0, -1.0}) { // left, right
            btWheelInfo& wheel =
                vehicle->addWheel(to_bullet({side * axle.track_m / 2, height, axle.ahead_m}),
                                  {0, -1, 0}, {-1, 0, 0}, static_cast<btScalar>(axle.travel_m),
                                  static_cast<btScalar>(axle.radius_m), tuning, number == 0);
            wheel.m_suspensionStiffness = static_cast<btScalar>(omega * omega * share);
            wheel.m_wheelsDampingCompression = wheel.m_wheelsDampingRelaxation =
                static_cast<btScalar>(2 * axle.damping * omega * share);
            wheel.m_maxSuspensionTravelCm = static_cast<btScalar>(axle.travel_m * 100);
            wheel.m_maxSuspensionForce = static_cast<btScalar>(spec.mass_kg * kGravity * 10);
            wheel.m_rollInfluence = static_cast<btScalar>(kRollInfluence);
        }
    }

    [[nodiscard]] glm::dvec3 middle() const {
        return origin + of_bullet(body->getWorldTransform().getOrigin());
    }

    void put(double x, double z, double yaw_deg) {
        origin = {std::round(x), std::round(land.height(x, z)), std::round(z)};
        rays.set_origin(origin);
        const glm::dvec3 at =
            glm::dvec3(x, land.height(x, z) + spec.mass_height_m + 0.05, z) - origin;
        btTransform place;
        place.setOrigin(to_bullet(at));
        place.setRotation(
            btQuaternion(btVector3(0, 1, 0),
                         static_cast<btScalar>(glm::pi<double>() - yaw_deg * base::kDegree)));
        body->setWorldTransform(place);
        body->setInterpolationWorldTransform(place);
        body->setLinearVelocity({0, 0, 0});
        body->setAngularVelocity({0, 0, 0});
        vehicle->resetSuspension();
        steer = rest_s = overturned_s = 0;
        resting = false;
        note();
        before = now;
    }

    /// Bullet's origin goes along, by whole metres, so that nothing else moves.
    void follow_origin() {
        const btVector3 at = body->getWorldTransform().getOrigin();
        if (std::abs(at.x()) < kFarthest_m && std::abs(at.y()) < kFarthest_m &&
            std::abs(at.z()) < kFarthest_m)
            return;
        const glm::dvec3 shift = glm::round(of_bullet(at));
        origin += shift;
        rays.set_origin(origin);
        btTransform place = body->getWorldTransform();
        place.setOrigin(at - to_bullet(shift));
        body->setWorldTransform(place);
        body->setInterpolationWorldTransform(place);
    }

    [[nodiscard]] Surface surface_at(const glm::dvec3& at) const {
        return land.surface ? land.surface(at.x, at.z) : Surface::kGrass;
    }

    /// Engine and brakes.
    void pedal(const Pedals& pedals) {
        const double speed = now.speed_mps(), drive = std::clamp(pedals.drive, -1.0, 1.0);
        const bool against = drive * speed < 0 && std::abs(speed) > kTurning_mps;
        const double top = (drive < 0 ? spec.reverse_kmh : spec.top_kmh) / 3.6;
        double pull = against || std::abs(speed) >= top
                          ? 0
                          : drive * std::min(spec.pull_kn * 1000,
                                             spec.power_kw * 1000 / std::max(1.0, std::abs(speed)));
        double brake =
            spec.brake_kn * 1000 *
            std::max(against ? std::abs(drive) : 0.0, std::clamp(pedals.brake, 0.0, 1.0));
        if (pedals.brake > 0)
            pull = 0;
        if (pedals.idle() && std::abs(speed) < kParking_mps)
            brake = spec.mass_kg * kGravity; // parked
        double load = 0;
        for (const WheelState& wheel : now.wheels)
            load += wheel.load_n;
        const int driven = (spec.axles[0].driven ? 2 : 0) + (spec.axles[1].driven ? 2 : 0);
        for (int i = 0; i < 4; ++i) {
            const AxleSpec& axle = spec.axles[static_cast<std::size_t>(i / 2)];
            // Bullet lets a wheel that goes straight pull and brake without end: tyres do not.
            const double own = now.wheels[static_cast<std::size_t>(i)].load_n,
                         most = grip[static_cast<std::size_t>(i)] * own;
            const double share =
                load > 0 ? own / load : 0.25; // of the brakes: as much as it carries
            vehicle->applyEngineForce(
                static_cast<btScalar>(axle.driven ? std::clamp(pull / driven, -most, most) : 0), i);
            vehicle->setBrake(static_cast<btScalar>(std::min(brake * share, most) * kStep_s),
                              i); // Bullet takes it as an impulse
            vehicle->setSteeringValue(
                static_cast<btScalar>(-steer * axle.steer_deg * base::kDegree), i);
        }
    }

    void steer_towards(double wanted) {
        const double most = kSteerFade_mps / (kSteerFade_mps + std::abs(now.speed_mps()));
        const double goal = std::clamp(wanted, -1.0, 1.0) * most, change = kSteer_per_s * kStep_s;
        steer += std::clamp(goal - steer, -change, change);
    }

    /// Tyres on what they stand on, and what holds the vehicle back.
    void grip_and_drag() {
        double rolling = 0;
        for (int i = 0; i < 4; ++i) {
            btWheelInfo& wheel = vehicle->getWheelInfo(i);
            const Surface under =
                surface_at(origin + of_bullet(wheel.m_raycastInfo.m_contactPointWS));
            const auto surface = static_cast<std::size_t>(under);
            now.wheels[static_cast<std::size_t>(i)].surface = under;
            grip[static_cast<std::size_t>(i)] = spec.grip[surface];
            wheel.m_frictionSlip = static_cast<btScalar>(spec.grip[surface]);
            if (wheel.m_raycastInfo.m_isInContact)
                rolling +=
                    spec.rolling[surface] * static_cast<double>(wheel.m_wheelsSuspensionForce);
        }
        const glm::dvec3 velocity = of_bullet(body->getLinearVelocity());
        const double speed = glm::length(velocity);
        if (speed < 1e-3)
            return;
        const double most = spec.mass_kg * speed / kStep_s; // that stops it within the step
        const double force = std::min(most, rolling * std::min(1.0, speed) +
                                                0.5 * kAir * spec.drag_m2 * speed * speed);
        body->applyCentralForce(to_bullet(velocity * (-force / speed)));
    }

    /// The body's corners on the ground: a belly that grounds, a vehicle on its side.
    void meet_ground() {
        const btTransform& place = body->getWorldTransform();
        const glm::dvec3 half = spec.size_m * 0.5;
        const double under = spec.clearance_m - spec.mass_height_m, over = under + spec.size_m.y;
        for (const double x : {-half.x, half.x})
            for (const double y : {under, over})
                for (const double z : {-half.z, half.z}) {
                    const btVector3 arm = place.getBasis() * to_bullet({x, y, z});
                    const glm::dvec3 at = origin + of_bullet(place.getOrigin() + arm);
                    const double depth = land.height(at.x, at.z) - at.y;
                    if (depth <= 0)
                        continue;
                    const glm::dvec3 up = rays.normal(at.x, at.z),
                                     velocity = of_bullet(body->getVelocityInLocalPoint(arm));
                    const double away = glm::dot(velocity, up);
                    const double push =
                        std::max(0.0, spec.mass_kg *
                                          (kBodySpring * std::min(depth, 0.5) * up.y -
                                           kBodyDamping * away) *
                                          0.25) *
                        kStep_s;
                    const glm::dvec3 along = velocity - up * away;
                    const double rub =
                        std::min(kBodyGrip * push, 0.25 * spec.mass_kg * glm::length(along));
                    const glm::dvec3 impulse =
                        up * push -
                        (glm::length(along) > 1e-6 ? glm::normalize(along) * rub : glm::dvec3(0));
                    body->applyImpulse(to_bullet(impulse), arm);
                }
    }

    /// What must never be: through the ground, nowhere, on its roof for good.
    void rescue() {
        if (!is_finite(*body)) {
            put(now.position.x, now.position.z, 0);
            return;
        }
        const glm::dvec3 at = middle();
        const double sunk = land.height(at.x, at.z) - at.y;
        if (sunk > kSunk_m) {
            btTransform place = body->getWorldTransform();
            place.setOrigin(place.getOrigin() + btVector3(0, static_cast<btScalar>(sunk), 0));
            body->setWorldTransform(place);
            body->setLinearVelocity({0, 0, 0});
        }
        const bool over = body->getWorldTransform().getBasis()[1][1] < 0.3f;
        overturned_s = over && body->getLinearVelocity().length() < 1 ? overturned_s + kStep_s : 0;
        if (overturned_s > kOverturned_s) {
            const glm::dvec3 ahead = now.ahead();
            put(at.x, at.z, std::atan2(ahead.x, -ahead.z) / base::kDegree);
        }
    }

    void step(const Pedals& pedals) {
        before = now;
        steer_towards(pedals.steer);
        if (resting && pedals.drive == 0)
            return;
        resting = false;
        grip_and_drag();
        pedal(pedals);
        meet_ground();
        world.stepSimulation(static_cast<btScalar>(kStep_s), 0);
        follow_origin();
        rescue();
        note();
        const bool calm = pedals.drive == 0 &&
                          body->getLinearVelocity().length() < static_cast<btScalar>(kRest_mps) &&
                          body->getAngularVelocity().length() < static_cast<btScalar>(kRest_rads);
        rest_s = calm ? rest_s + kStep_s : 0;
        resting =
            rest_s > kRest_s; // Bullet's tyres creep sideways down a slope; a parked car does not
        if (resting) {
            body->setLinearVelocity({0, 0, 0});
            body->setAngularVelocity({0, 0, 0});
            now.velocity_mps = {0, 0, 0};
            before = now;
        }
    }

    /// Bullet's state as ours.
    void note() {
        const btTransform& place = body->getWorldTransform();
        const btQuaternion q = place.getRotation();
        now.turn = glm::normalize(glm::dquat(q.w(), q.x(), q.y(), q.z()) *
                                  glm::dquat(0, 0, 1, 0)); // half a turn around y
        now.position = middle() + now.turn * glm::dvec3(0, -spec.mass_height_m, 0);
        now.velocity_mps = of_bullet(body->getLinearVelocity());
        for (std::size_t i = 0; i < 4; ++i) {
            const btWheelInfo& wheel = vehicle->getWheelInfo(static_cast<int>(i));
            // Not by updateWheelTransform(), which forgets what the wheel touches.
            const btScalar length = wheel.m_raycastInfo.m_suspensionLength;
            now.wheels[i].hub = origin + of_bullet(place * (wheel.m_chassisConnectionPointCS +
                                                            wheel.m_wheelDirectionCS * length));
            now.wheels[i].turn =
                now.turn *
                glm::angleAxis(static_cast<double>(wheel.m_steering), glm::dvec3(0, 1, 0)) *
                glm::angleAxis(-static_cast<double>(wheel.m_rotation), glm::dvec3(1, 0, 0));
            now.wheels[i].touches = wheel.m_raycastInfo.m_isInContact;
            now.wheels[i].contact = origin + of_bullet(wheel.m_raycastInfo.m_contactPointWS);
            now.wheels[i].load_n = wheel.m_raycastInfo.m_isInContact
                                       ? static_cast<double>(wheel.m_wheelsSuspensionForce)
                                       : 0;
        }
    }

    VehicleSpec spec;
    DriveLand land;
    GroundRays rays;
    glm::dvec3 origin{0};
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btBoxShape box;
    std::unique_ptr<btRigidBody> body;
    std::unique_ptr<btRaycastVehicle> vehicle;
    VehicleState before, now;     ///< of the last two steps
    std::array<double, 4> grip{}; ///< of the tyres, where they stand
    double steer = 0, owed_s = 0, rest_s = 0, overturned_s = 0;
    bool resting = false;
};

Vehicle::Vehicle(const VehicleSpec& spec, DriveLand land)
    : inside_(std::make_unique<Inside>(spec, std::move(land))) {
    put(0, 0, 0);
}
Vehicle::~Vehicle() = default;

void Vehicle::put(double x, double z, double yaw_deg) {
    inside_->put(x, z, yaw_deg);
}

void Vehicle::advance(double dt_s, const Pedals& pedals) {
    inside_->owed_s += std::isfinite(dt_s) ? std::clamp(dt_s, 0.0, kMost_s) : 0.0;
    while (inside_->owed_s >= kStep_s) {
        inside_->owed_s -= kStep_s;
        inside_->step(pedals);
    }
}

VehicleState Vehicle::state() const {
    const double share = std::clamp(inside_->owed_s / kStep_s, 0.0, 1.0);
    const VehicleState &a = inside_->before, &b = inside_->now;
    VehicleState between = b;
    between.position = a.position + (b.position - a.position) * share;
    between.turn = glm::slerp(a.turn, b.turn, share);
    between.velocity_mps = a.velocity_mps + (b.velocity_mps - a.velocity_mps) * share;
    for (std::size_t i = 0; i < 4; ++i) {
        between.wheels[i].hub = a.wheels[i].hub + (b.wheels[i].hub - a.wheels[i].hub) * share;
        between.wheels[i].turn = glm::slerp(a.wheels[i].turn, b.wheels[i].turn, share);
    }
    return between;
}

const VehicleSpec& Vehicle::spec() const {
    return inside_->spec;
}

} // namespace sward::drive
