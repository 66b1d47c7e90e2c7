// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "render/view_state.h"

namespace sward::render {

namespace {

/// Channels that an AOV name stands for, and where they come from: 0 colour, 1 data, 2 tangent, 3
/// normal.
struct Aov {
    const char* name;
    int source;
    int first;
    std::vector<std::string> channels;
    bool needs_aov;
};

const std::vector<Aov>& table() {
    static const std::vector<Aov> kTable = {
        {"color", 0, 0, {"R", "G", "B", "A"}, false},
        {"coverage", 0, 3, {"coverage"}, false},
        {"depth", 1, 0, {"depth"}, false},
        {"tier", 1, 1, {"tier"}, true},
        {"rank", 1, 2, {"rank"}, true},
        {"tangent", 2, 0, {"tangent.X", "tangent.Y", "tangent.Z"}, true},
        {"normal", 3, 0, {"normal.X", "normal.Y", "normal.Z"}, true},
    };
    return kTable;
}

} // namespace

scene::Picture ViewState::read_picture() const {
    scene::Picture picture{targets.width(), targets.height(), {}};
    const std::size_t row = static_cast<std::size_t>(picture.width) * 3;
    std::vector<std::uint8_t> upside_down(row * picture.height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(targets.picture().id(), 0, GL_RGB, GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(upside_down.size()), upside_down.data());
    picture.rgb.resize(upside_down.size());
    for (int y = 0; y < picture.height; ++y) {
        std::copy_n(upside_down.data() + static_cast<std::size_t>(picture.height - 1 - y) * row,
                    row, picture.rgb.data() + static_cast<std::size_t>(y) * row);
    }
    return picture;
}

scene::Image ViewState::read_aovs(const std::vector<std::string>& names) const {
    std::vector<float> sources[4];
    scene::Image image{targets.width(), targets.height(), {}, {}, {}};
    std::vector<std::pair<int, int>> picks; // source, component
    for (const std::string& name : names) {
        const auto aov = std::find_if(table().begin(), table().end(),
                                      [&](const Aov& a) { return name == a.name; });
        if (aov == table().end() || (aov->needs_aov && !targets.aov())) {
            throw base::Error(
                base::ExitCode::kUsage,
                fmt::format(
                    "aov: found {}, expected color, depth, tier, coverage, tangent, normal or rank",
                    base::printable(name)));
        }
        for (std::size_t i = 0; i < aov->channels.size(); ++i) {
            image.channels.push_back(aov->channels[i]);
            picks.emplace_back(aov->source, aov->first + static_cast<int>(i));
        }
        if (sources[aov->source].empty()) {
            const gl::Texture* textures[] = {&targets.color(), &targets.data(), &targets.tangent(),
                                             &targets.normal()};
            sources[aov->source] = textures[aov->source]->read_floats(4);
        }
    }
    image.texels.reserve(static_cast<std::size_t>(image.width) * image.height * picks.size());
    for (int y = image.height - 1; y >= 0; --y) {
        for (int x = 0; x < image.width; ++x) {
            for (const auto& [source, component] : picks) {
                const bool alpha = source == 0 && component == 3 &&
                                   std::find(image.channels.begin(), image.channels.end(), "A") !=
                                       image.channels.end() &&
                                   image.channels[image.texels.size() % picks.size()] == "A";
                image.texels.push_back(
                    alpha ? 1.0f
                          : sources[source][(static_cast<std::size_t>(y) * image.width + x) * 4 +
                                            component]);
            }
        }
    }
    return image;
}

} // namespace sward::render
