// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "app/flight_record.h"
#include "sward/field.h"

namespace sward::app {

/// From pictures at any rate to fixed steps: those that fell between the last picture and this one,
/// on the straight way between their poses.
class StepSampler {
public:
    explicit StepSampler(double start_s) : start_s_(start_s) {}
    /// The steps up to `time_s`. `asked` holds what the picture asked for; its pose is not looked
    /// at.
    [[nodiscard]] std::vector<RecordStep> up_to(double time_s, const ViewPose& pose,
                                                const RecordStep& asked);
    [[nodiscard]] std::size_t count() const { return next_; } ///< of all steps so far
    [[nodiscard]] double time_of(std::size_t step) const {
        return start_s_ + static_cast<double>(step) / kRecordRate;
    }

private:
    double start_s_;
    double before_s_ = 0;
    std::optional<ViewPose> before_;
    std::size_t next_ = 0;
};

/// Simulates a field by the steps of a record, each once and in order: what is drawn then depends
/// on the time alone, not on the pictures before.
class RecordedTime {
public:
    /// `limits` as of a picture's settings, but for those on what a frame may cost.
    RecordedTime(Field& field, const SimulationLimits& limits);
    /// Does one step, as at `time_s`.
    void step(double time_s, const glm::dvec3& eye);
    /// Does the steps of a record up to a time, with what changed before each, that have not been
    /// done.
    void follow(const FlightRecord& record, double time_s);

private:
    void apply(const RecordEvent& event);
    Field& field_;
    SimulationLimits limits_;
    std::size_t done_ = 0, events_done_ = 0;
};

} // namespace sward::app
