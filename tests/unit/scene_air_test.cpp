// SPDX-License-Identifier: Apache-2.0
// [air] of the scene file.
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"

namespace sward {
namespace {

scene::Scene scene_with(const std::string& air) {
    return scene::parse_scene("[terrain]\nelevation = \"a.hgt\"\n" + air, "scene.toml");
}

std::string refused(const std::string& air) {
    try {
        static_cast<void>(scene_with(air));
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ExitCode::kBadInput);
        return error.what();
    }
    return {};
}

TEST(AirSection, IsReadAndHasADefault) {
    EXPECT_EQ(scene_with("").air.visibility_km, 60);
    EXPECT_EQ(scene_with("[air]\n").air.visibility_km, 60);
    EXPECT_EQ(scene_with("[air]\nvisibility_km = 12.5\n").air.visibility_km, 12.5);
}

TEST(AirSection, RefusesWhatNoAirIs) {
    for (const char* value : {"0", "0.09", "251", "-5", "nan", "inf", "\"far\""}) {
        const std::string message = refused(std::string("[air]\nvisibility_km = ") + value + "\n");
        EXPECT_NE(message.find("air.visibility_km"), std::string::npos) << value << ": " << message;
    }
    EXPECT_NE(refused("[air]\nvisibilty_km = 5\n").find("expected air.visibility_km"),
              std::string::npos);
}

} // namespace
} // namespace sward
