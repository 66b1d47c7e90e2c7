// SPDX-License-Identifier: Apache-2.0
#include "app/io.h"

#include "assets/assets.h"
#include "assets/place_finder.h"

namespace sward::app {

std::string_view build_name() {
    return "full";
}
std::string format_libraries() {
    return assets::library_versions();
}

scene::Heightfield load_elevation(const scene::TerrainSpec& spec) {
    return assets::load_elevation(spec);
}

scene::DensityMask load_mask(const scene::TerrainSpec& spec, const scene::Heightfield& ground) {
    return assets::load_mask(spec, ground);
}

scene::PlaceOnEarth place_on_earth(const scene::Heightfield& ground) {
    if (!ground.origin)
        return {};
    return assets::place_finder(*ground.origin);
}

scene::Mesh load_mesh(const std::filesystem::path& path) {
    return assets::load_mesh(path);
}

std::vector<std::string_view> picture_extensions() {
    return {"png", "exr"};
}
std::string_view display_extension() {
    return "png";
}
bool is_linear(const std::filesystem::path& path) {
    return path.extension() == ".exr";
}

void write_display(const std::filesystem::path& path, const scene::Picture& picture) {
    assets::write_png(path, picture);
}

void write_linear(const std::filesystem::path& path, const scene::Image& image) {
    assets::write_exr(path, image);
}

scene::Image read_linear(const std::filesystem::path& path) {
    return assets::read_exr(path);
}

} // namespace sward::app
