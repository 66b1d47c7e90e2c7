// SPDX-License-Identifier: Apache-2.0
// Records of flights: what is kept, what comes back, and what a bad file is told.
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "app/flight_record.h"
#include "app/recorder.h"
#include "base/error.h"
#include "base/file.h"

namespace {

using namespace sward::app;
namespace fs = std::filesystem;

ViewPose at(double x, double yaw = 0) {
    ViewPose view;
    view.pose.position = {x, 2, -x};
    view.pose.yaw_deg = yaw;
    view.pose.agl = false;
    return view;
}

const std::string kHead = "sward-record 1\nrate 60\nstart 2\n";
const std::string kStep = "step 1 2 3 350 -5 0 60 0 0 1 0 0 0\n";

TEST(Record, ComesBackBitForBit) {
    const fs::path file =
        fs::temp_directory_path() / ("sward-record-" + std::to_string(::getpid()));
    FlightRecord wanted;
    for (int i = 0; i < 100; ++i) {
        RecordStep step;
        step.position = {std::sin(i) * 1e4, 1.0 / (i + 1), -i / 3.0};
        step.yaw_deg = std::cos(i) * 180;
        step.move = {0, -1, 1.0 / 3};
        step.look_px = {i * 0.1, 0};
        wanted.steps.push_back(step);
    }
    {
        RecordWriter writer(file, "a scene", 0.1);
        for (int i = 0; i < 100; ++i) {
            if (i == 50) {
                writer.add(sward::Sun{123.456, 7.0 / 3});
                writer.add(sward::MeanWind{9, 45, 0.1});
            }
            writer.add(wanted.steps[static_cast<std::size_t>(i)]);
        }
    }
    const FlightRecord record = read_record(file);
    fs::remove(file);
    EXPECT_EQ(record.scene, "a scene");
    EXPECT_EQ(record.start_s, 0.1);
    ASSERT_EQ(record.steps, wanted.steps);
    ASSERT_EQ(record.events.size(), 2u);
    EXPECT_EQ(record.events[0].step, 50u);
    EXPECT_EQ(std::get<sward::Sun>(record.events[0].change).elevation_deg, 7.0 / 3);
    EXPECT_EQ(std::get<sward::MeanWind>(record.events[1].change).speed_mps, 9);
}

TEST(Record, PosesAreOfTheTimeWhateverItsSum) {
    FlightRecord record;
    for (int i = 0; i < 120; ++i) {
        RecordStep step;
        step.position = {i * i * 0.01, 1, std::sqrt(i)};
        step.yaw_deg = i % 2 == 0 ? 350 : 10; // by the short way, through north
        record.steps.push_back(step);
    }
    for (int i = 0; i < 5; ++i) { // every sixth of a second at 30 and at 144 pictures a second
        const double a = i * 5 * (1.0 / 30), b = i * 24 * (1.0 / 144);
        EXPECT_EQ(record.pose_at(a).pose.position, record.pose_at(b).pose.position) << i;
        EXPECT_EQ(record.step_at(a), record.step_at(b));
        EXPECT_EQ(record.step_at(a), static_cast<std::size_t>(i * 10));
        EXPECT_EQ(record.pose_at(a).pose.position,
                  record.steps[static_cast<std::size_t>(i * 10)].position);
    }
    const ViewPose half = record.pose_at(0.5 / 60);
    EXPECT_NEAR(half.pose.position.x, 0.005, 1e-12);
    EXPECT_NEAR(std::remainder(half.pose.yaw_deg, 360), 0, 1e-9);
    EXPECT_EQ(record.pose_at(-1).pose.position, record.steps.front().position);
    EXPECT_EQ(record.pose_at(1e9).pose.position, record.steps.back().position);
    EXPECT_EQ(record.step_at(std::nan("")), record.step_at(-1));
}

TEST(Record, StepsAreTakenFromPicturesAtAnyRate) {
    const auto run = [](double rate) {
        StepSampler sampler(0);
        std::vector<RecordStep> all;
        for (int i = 0; i <= static_cast<int>(rate); ++i) {
            const double time = i / rate;
            const auto some = sampler.up_to(time, at(time * 10), {});
            all.insert(all.end(), some.begin(), some.end());
        }
        EXPECT_EQ(sampler.count(), all.size());
        return all;
    };
    for (const double rate : {1.0, 7.0, 30.0, 60.0, 144.0, 240.0}) {
        const auto steps = run(rate);
        ASSERT_EQ(steps.size(), 61u) << rate;
        for (std::size_t k = 0; k < steps.size(); ++k)
            EXPECT_NEAR(steps[k].position.x, static_cast<double>(k) / 6, 1e-9) << rate << " " << k;
    }
}

TEST(Record, APictureOnAStepIsThatStepBitForBit) {
    StepSampler sampler(0.3);
    for (int i = 0; i < 50; ++i) {
        const ViewPose pose = at(std::sin(i) * 1000, 17.123 * i);
        double time = 0.3;
        for (int k = 0; k < i; ++k)
            time += 1.0 / 60; // as a clock sums
        RecordStep asked;
        asked.wheel = 1;
        const auto steps = sampler.up_to(time, pose, asked);
        ASSERT_EQ(steps.size(), 1u) << i;
        EXPECT_EQ(steps[0].position, pose.pose.position);
        EXPECT_EQ(steps[0].yaw_deg, pose.pose.yaw_deg);
        EXPECT_EQ(steps[0].wheel, 1);
    }
    RecordStep asked;
    asked.look_px = {8, 0};
    const auto three = sampler.up_to(0.3 + 52.0 / 60, at(0), asked);
    ASSERT_EQ(three.size(), 3u);
    EXPECT_EQ(three[0].look_px.x, 8);
    EXPECT_EQ(three[1].look_px.x, 0);
    EXPECT_TRUE(sampler.up_to(0.3 + 52.0 / 60, at(0), asked).empty()); // time stands
}

TEST(Record, ATornLastLineIsLeftOut) {
    EXPECT_EQ(parse_record(kHead + kStep + kStep.substr(0, 20), "r").steps.size(), 1u);
    EXPECT_EQ(parse_record(kHead + kStep + kStep, "r").steps.size(), 2u);
}

TEST(Record, ABadFileIsToldWithItsLine) {
    const std::string bad[] = {
        "",
        "sward-record 2\n" + kStep,
        kHead,
        kHead + "step 1 2 3\n",
        kHead + "step nan 2 3 350 -5 0 60 0 0 1 0 0 0\n",
        kHead + "step 1e300 2 3 350 -5 0 60 0 0 1 0 0 0\n",
        kHead + "step 1 2 3 350 -5 0 0 0 0 1 0 0 0\n",
        kHead + "sun 1 91\n" + kStep,
        kHead + "wind -1 0 0\n" + kStep,
        kHead + "jump 3\n" + kStep,
        "sward-record 1\nrate 50\n" + kStep,
        kHead + std::string(5, '\0') + "\n" + kStep,
    };
    for (const std::string& text : bad)
        try {
            static_cast<void>(parse_record(text, "flight.rec"));
            ADD_FAILURE() << text;
        } catch (const sward::base::Error& error) {
            EXPECT_EQ(error.code(), sward::base::ExitCode::kBadInput) << text;
            EXPECT_EQ(std::string(error.what()).find("flight.rec"), 0u) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
}

} // namespace
