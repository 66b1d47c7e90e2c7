// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/view_pose.h"
#include "sward/field.h"

namespace sward::app {

/// Steps of a record a second: those of the blades and, by default, of the wind.
inline constexpr int kRecordRate = 60;

struct RecordStep {
    glm::dvec3 position{0}; ///< above the datum
    double yaw_deg = 0, pitch_deg = 0, roll_deg = 0, fov_deg = 60;
    // What was asked for in the picture that the step belongs to; the look and the wheel stand in
    // the first of its steps.
    glm::dvec3 move{0};
    glm::dvec2 look_px{0};
    double wheel = 0;
    bool operator==(const RecordStep&) const = default;
};

/// What changed at a step, before it was simulated.
struct RecordEvent {
    std::size_t step = 0;
    std::variant<Sun, MeanWind> change;
};

/// A flight at fixed steps of 1 / kRecordRate s. Its pictures are a function of the time alone.
struct FlightRecord {
    std::string scene; ///< that it was flown in, for people
    double start_s = 0;
    std::vector<RecordStep> steps;   ///< one or more
    std::vector<RecordEvent> events; ///< in the order of their steps

    [[nodiscard]] double time_of(std::size_t step) const {
        return start_s + static_cast<double>(step) / kRecordRate;
    }
    [[nodiscard]] double end_s() const { return time_of(steps.size() - 1); }
    /// The last step at or before a time; held at both ends.
    [[nodiscard]] std::size_t step_at(double time_s) const;
    /// Between two steps on the straight line, by the shortest turn. Times that differ by less than
    /// a millionth of a step are one time, so that 5 / 30 s and 24 / 144 s give the same bits.
    [[nodiscard]] ViewPose pose_at(double time_s) const;

private:
    [[nodiscard]] double steps_to(double time_s) const;
};

/// Reads a record. A last line that is torn is left out: the program that wrote it may have been
/// killed. Throws Error: kBadInput with file and line, kOverLimit, kIo.
[[nodiscard]] FlightRecord parse_record(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] FlightRecord read_record(const std::filesystem::path& file);

/// A record in the making. It grows as the flight goes on; what a killed program loses is the last
/// second.
class RecordWriter {
public:
    /// Begins the file anew. Throws Error(kIo).
    RecordWriter(std::filesystem::path file, const std::string& scene, double start_s);
    /// Throw Error(kIo), once the disk is full.
    void add(const RecordStep& step);
    void add(const Sun& sun);
    void add(const MeanWind& wind);
    void flush();

private:
    void write(const std::string& line);
    std::filesystem::path path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    int unflushed_ = 0;
};

} // namespace sward::app
