// SPDX-License-Identifier: Apache-2.0
#include "app/flight_record.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

constexpr std::uint64_t kFileLimit = std::uint64_t{512} << 20; // two hours and a half
constexpr std::string_view kHead = "sward-record 1";
constexpr double kFinest = 1e6; // parts of a step
constexpr double kPlace_m = 1e7, kAngle_deg = 1e6, kTime_s = 1e9;

/// A line's words and where it stands.
class Line {
public:
    Line(std::string_view text, const fs::path& file, int number) : file_(file), number_(number) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find(' '), text.size());
            if (end > 0)
                words_.push_back(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    }
    [[nodiscard]] std::string_view word(std::size_t i) const {
        return i < words_.size() ? words_[i] : std::string_view();
    }
    [[nodiscard]] base::Error wrong(std::string_view found, const std::string& expected) const {
        return base::input_error(ExitCode::kBadInput, file_, number_, "record", std::string(found),
                                 expected);
    }
    void require(std::size_t count) const {
        if (words_.size() != count)
            throw wrong(fmt::format("{} words", words_.size()), fmt::format("{}", count));
    }
    [[nodiscard]] double number(std::size_t i, double least, double most) const {
        double value = 0;
        const std::string_view text = word(i);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() ||
            !(value >= least && value <= most))
            throw wrong(text, fmt::format("a number from {} to {}", least, most));
        return value;
    }

private:
    const fs::path& file_;
    int number_;
    std::vector<std::string_view> words_;
};

RecordStep step_of(const Line& line) {
    line.require(14);
    RecordStep step;
    const auto place = [&](std::size_t i) { return line.number(i, -kPlace_m, kPlace_m); };
    const auto angle = [&](std::size_t i) { return line.number(i, -kAngle_deg, kAngle_deg); };
    step.position = {place(1), place(2), place(3)};
    step.yaw_deg = angle(4);
    step.pitch_deg = line.number(5, -90, 90);
    step.roll_deg = angle(6);
    step.fov_deg = line.number(7, 1, 170);
    step.move = {line.number(8, -1, 1), line.number(9, -1, 1), line.number(10, -1, 1)};
    step.look_px = {angle(11), angle(12)};
    step.wheel = angle(13);
    return step;
}

void take_line(const Line& line, FlightRecord& record) {
    const std::string_view kind = line.word(0);
    if (kind == "step") {
        record.steps.push_back(step_of(line));
    } else if (kind == "sun") {
        line.require(3);
        record.events.push_back({record.steps.size(), Sun{line.number(1, -kAngle_deg, kAngle_deg),
                                                          line.number(2, -90, 90)}});
    } else if (kind == "wind") {
        line.require(4);
        record.events.push_back(
            {record.steps.size(),
             MeanWind{line.number(1, 0, 60), line.number(2, -kAngle_deg, kAngle_deg),
                      line.number(3, 0, 1)}});
    } else if (kind == "start") {
        line.require(2);
        record.start_s = line.number(1, 0, kTime_s);
    } else if (kind == "rate") {
        line.require(2);
        if (line.number(1, 1, 1e6) != kRecordRate)
            throw line.wrong(line.word(1), fmt::format("{} steps a second", kRecordRate));
    } else {
        throw line.wrong(kind, "step, sun, wind, start, rate or scene");
    }
}

double turned(double from_deg, double to_deg, double share) {
    return from_deg + share * std::remainder(to_deg - from_deg, 360.0);
}

} // namespace

double FlightRecord::steps_to(double time_s) const {
    const double at = std::round((time_s - start_s) * kRecordRate * kFinest) / kFinest;
    return at > 0 ? std::min(at, static_cast<double>(steps.size() - 1)) : 0; // NaN too
}

std::size_t FlightRecord::step_at(double time_s) const {
    return static_cast<std::size_t>(steps_to(time_s));
}

ViewPose FlightRecord::pose_at(double time_s) const {
    const double at = steps_to(time_s);
    const auto i = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(i);
    const RecordStep& a = steps[i];
    const RecordStep& b = share > 0 && i + 1 < steps.size() ? steps[i + 1] : a;
    ViewPose pose;
    pose.pose.position = a.position + (b.position - a.position) * share;
    pose.pose.yaw_deg = turned(a.yaw_deg, b.yaw_deg, share);
    pose.pose.pitch_deg = a.pitch_deg + (b.pitch_deg - a.pitch_deg) * share;
    pose.pose.fov_deg = a.fov_deg + (b.fov_deg - a.fov_deg) * share;
    pose.pose.agl = false;
    pose.roll_deg = turned(a.roll_deg, b.roll_deg, share);
    return pose;
}

FlightRecord parse_record(std::string_view text, const fs::path& file) {
    FlightRecord record;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos)
            break; // torn
        const std::string_view whole = text.substr(0, end);
        text.remove_prefix(end + 1);
        if (number == 1) {
            if (whole != kHead)
                throw base::input_error(ExitCode::kBadInput, file, 1, "record",
                                        std::string(whole.substr(0, 100)), std::string(kHead));
        } else if (whole.starts_with("scene ")) {
            record.scene = base::printable(whole.substr(6), 1024);
        } else {
            take_line(Line(whole, file, number), record);
        }
    }
    if (record.steps.empty())
        throw base::input_error(ExitCode::kBadInput, file, 0, "record", "no step", "one or more");
    return record;
}

FlightRecord read_record(const fs::path& file) {
    return parse_record(base::read_text(file, kFileLimit), file);
}

RecordWriter::RecordWriter(fs::path file, const std::string& scene, double start_s)
    : path_(std::move(file)), file_(std::fopen(path_.c_str(), "we"), std::fclose) {
    if (!file_)
        throw base::input_error(ExitCode::kIo, path_, 0, "cannot write the record",
                                std::strerror(errno), "a file that can be made");
    write(fmt::format("{}\nscene {}\nrate {}\nstart {}\n", kHead, base::printable(scene, 1024),
                      kRecordRate, start_s));
    flush();
}

void RecordWriter::write(const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size())
        throw base::input_error(ExitCode::kIo, path_, 0, "cannot write the record",
                                std::strerror(errno), "room on the disk");
}

void RecordWriter::flush() {
    unflushed_ = 0;
    if (std::fflush(file_.get()) != 0)
        throw base::input_error(ExitCode::kIo, path_, 0, "cannot write the record",
                                std::strerror(errno), "room on the disk");
}

void RecordWriter::add(const RecordStep& s) {
    // fmt's shortest form that reads back to the same double.
    write(fmt::format("step {} {} {} {} {} {} {} {} {} {} {} {} {}\n", s.position.x, s.position.y,
                      s.position.z, s.yaw_deg, s.pitch_deg, s.roll_deg, s.fov_deg, s.move.x,
                      s.move.y, s.move.z, s.look_px.x, s.look_px.y, s.wheel));
    if (++unflushed_ >= kRecordRate)
        flush();
}

void RecordWriter::add(const Sun& sun) {
    write(fmt::format("sun {} {}\n", sun.azimuth_deg, sun.elevation_deg));
}

void RecordWriter::add(const MeanWind& wind) {
    write(fmt::format("wind {} {} {}\n", wind.speed_mps, wind.direction_deg, wind.gust));
}

} // namespace sward::app
