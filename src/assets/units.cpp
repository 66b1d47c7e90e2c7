// SPDX-License-Identifier: Apache-2.0
#include "assets/units.h"

#include <array>
#include <string>
#include <utility>

namespace sward::assets {
namespace {

constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;

// Small letters, and nothing but letters and the marks of feet.
constexpr std::array<std::pair<std::string_view, double>, 46> kUnits = {
    {{"m", 1},
     {"metre", 1},
     {"meter", 1},
     {"metres", 1},
     {"meters", 1},
     {"mtr", 1},
     {"metro", 1},
     {"metros", 1},
     {"dm", 0.1},
     {"decimetre", 0.1},
     {"decimeter", 0.1},
     {"decimetres", 0.1},
     {"decimeters", 0.1},
     {"cm", 0.01},
     {"centimetre", 0.01},
     {"centimeter", 0.01},
     {"centimetres", 0.01},
     {"centimeters", 0.01},
     {"mm", 0.001},
     {"millimetre", 0.001},
     {"millimeter", 0.001},
     {"millimetres", 0.001},
     {"millimeters", 0.001},
     {"km", 1000},
     {"kilometre", 1000},
     {"kilometer", 1000},
     {"kilometres", 1000},
     {"kilometers", 1000},
     {"ft", kFoot},
     {"foot", kFoot},
     {"feet", kFoot},
     {"ift", kFoot},
     {"internationalfoot", kFoot},
     {"internationalfeet", kFoot},
     {"footinternational", kFoot},
     {"'", kFoot},
     {"ftus", kSurveyFoot},
     {"usft", kSurveyFoot},
     {"sfeet", kSurveyFoot},
     {"sft", kSurveyFoot},
     {"footus", kSurveyFoot},
     {"feetus", kSurveyFoot},
     {"ussurveyfoot", kSurveyFoot},
     {"ussurveyfeet", kSurveyFoot},
     {"surveyfoot", kSurveyFoot},
     {"surveyfeet", kSurveyFoot}}};
constexpr std::array<std::pair<std::string_view, double>, 8> kMoreFeet = {
    {{"usfoot", kSurveyFoot},
     {"usfeet", kSurveyFoot},
     {"ussft", kSurveyFoot},
     {"footussurvey", kSurveyFoot},
     {"feetussurvey", kSurveyFoot},
     {"footsurveyus", kSurveyFoot},
     {"ftussurvey", kSurveyFoot},
     {"ussurveyft", kSurveyFoot}}};

} // namespace

std::optional<double> metres_of_unit(std::string_view text, bool& has_unit) {
    std::string name;
    for (const char c : text) {
        if (c >= 'A' && c <= 'Z')
            name += static_cast<char>(c - 'A' + 'a');
        else if ((c >= 'a' && c <= 'z') || c == '\'')
            name += c;
        else if (c != ' ' && c != '_' && c != '-' && c != '.' && c != '(' && c != ')' && c != ',' &&
                 c != '\t')
            return std::nullopt;
    }
    has_unit = !name.empty() && name != "unknown" && name != "none";
    if (!has_unit)
        return 1;
    for (const auto& [known, metres] : kUnits)
        if (name == known)
            return metres;
    for (const auto& [known, metres] : kMoreFeet)
        if (name == known)
            return metres;
    return std::nullopt;
}

} // namespace sward::assets
