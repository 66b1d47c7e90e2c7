// SPDX-License-Identifier: Apache-2.0
#include "app/camera_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "render/lens.h"

namespace sward::app {
namespace {

constexpr std::uint64_t kLimit = 1u << 16;

glm::dmat4 matrix_of(const nlohmann::json& json, const char* key,
                     const std::filesystem::path& file) {
    const auto found = json.is_object() ? json.find(key) : json.end();
    const bool fits = json.is_object() && found != json.end() && found->is_array() &&
                      found->size() == 16 &&
                      std::all_of(found->begin(), found->end(),
                                  [](const auto& number) { return number.is_number(); });
    if (!fits)
        throw base::input_error(base::ExitCode::kBadInput, file, 0, key,
                                json.is_object() && json.contains(key) ? json[key].dump()
                                                                       : "nothing",
                                "16 numbers, row by row");
    glm::dmat4 out(0);
    for (int i = 0; i < 16; ++i)
        out[i % 4][i / 4] = (*found)[static_cast<std::size_t>(i)].get<double>();
    return out;
}

} // namespace

Camera read_camera(const std::filesystem::path& file) {
    const std::string text = base::read_text(file, kLimit);
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded())
        throw base::input_error(base::ExitCode::kBadInput, file, 0, "camera", "no JSON",
                                "an object with view_from_world and clip_from_view");
    Camera camera;
    camera.view_from_world = matrix_of(json, "view_from_world", file);
    camera.clip_from_view = matrix_of(json, "clip_from_view", file);
    try { // before a set is baked for it
        static_cast<void>(render::lens_of(camera));
    } catch (const base::Error& error) {
        throw base::Error(error.code(),
                          fmt::format("{}: {}", base::printable(file.string(), 300), error.what()));
    }
    return camera;
}

} // namespace sward::app
