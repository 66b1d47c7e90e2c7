// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "app/flight_record.h"
#include "feed/led_frame.h"
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

/// Simulates a field by fixed steps, each once and in order: what is drawn then depends on what was
/// done alone, not on the pictures before.
class RecordedTime {
public:
    /// `limits` as of a picture's settings, but for those on what a frame may cost. `start_s`: the
    /// time of step 0.
    RecordedTime(Field& field, const SimulationLimits& limits, double start_s);
    /// Does what a picture does to its field: what moves in it is put where it is, then what
    /// changed, and the steps.
    void perform(const feed::LedFrame& frame);
    /// A record up to a time, as far as it was not taken before: frames of some steps each.
    [[nodiscard]] std::vector<feed::LedFrame> take_due(const FlightRecord& record, double time_s);
    /// Takes and performs those.
    void follow(const FlightRecord& record, double time_s);

private:
    void apply(const std::variant<Sun, MeanWind>& change);
    void place(const feed::LedFrame& frame);
    Field& field_;
    SimulationLimits limits_;
    double start_s_;
    std::size_t taken_ = 0, events_taken_ = 0; ///< of a record
};

/// Frames of no more steps than one may have; what is placed is placed by the first of them.
[[nodiscard]] std::vector<feed::LedFrame> cut_to_size(feed::LedFrame frame);

} // namespace sward::app
