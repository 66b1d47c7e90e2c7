// SPDX-License-Identifier: Apache-2.0
#include "app/io.h"

#include "base/error.h"
#include "scene/core_elevation.h"

namespace sward::app {

using base::ExitCode;

std::string_view build_name() {
    return "core";
}
std::string format_libraries() {
    return "none beyond the core's own";
}

scene::Heightfield load_elevation(const scene::TerrainSpec& spec) {
    return scene::read_core_elevation(spec);
}

scene::DensityMask load_mask(const scene::TerrainSpec& spec, const scene::Heightfield&) {
    throw base::input_error(ExitCode::kBadInput, spec.mask, 0, "mask", "an image",
                            "none (the core build reads no images)");
}

scene::PlaceOnEarth place_on_earth(const scene::Heightfield& ground) {
    if (!ground.origin)
        return {};
    return [frame = *ground.origin](double latitude, double longitude) {
        return scene::linear_place(frame, latitude, longitude);
    };
}

scene::Mesh load_mesh(const std::filesystem::path& path) {
    throw base::input_error(ExitCode::kBadInput, path, 0, "mesh", "glTF",
                            "none (the core build reads no meshes)");
}

std::vector<std::string_view> picture_extensions() {
    return {"ppm"};
}
std::string_view display_extension() {
    return "ppm";
}
bool is_linear(const std::filesystem::path&) {
    return false;
}

void write_display(const std::filesystem::path& path, const scene::Picture& picture) {
    scene::write_ppm(path, picture);
}

void write_linear(const std::filesystem::path& path, const scene::Image&) {
    throw base::input_error(ExitCode::kUsage, path, 0, "picture", "linear channels",
                            "a .ppm picture (the core build writes no other)");
}

scene::Image read_linear(const std::filesystem::path& path) {
    throw base::input_error(ExitCode::kBadInput, path, 0, "picture", "EXR",
                            "none (the core build reads no pictures)");
}

} // namespace sward::app
