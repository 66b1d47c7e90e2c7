// SPDX-License-Identifier: Apache-2.0
#include "grass/set_files.h"

#include <fmt/format.h>

namespace sward::grass {
namespace {

std::string level_file(const char* stem, int level) {
    return level == 0 ? fmt::format("{}.ktx2", stem) : fmt::format("{}_{}.ktx2", stem, level);
}

} // namespace

std::string layers_file(int level) {
    return level_file("layers", level);
}
std::string slabs_file(int set) {
    return level_file("slabs", set);
}
std::string slab_fibres_file(int set) {
    return level_file("slab_fibres", set);
}
std::string slices_file(int level) {
    return level_file("slices", level);
}
std::string layers_shape_file(int level) {
    return level_file("layers_shape", level);
}
std::string slices_shape_file(int level) {
    return level_file("slices_shape", level);
}

} // namespace sward::grass
