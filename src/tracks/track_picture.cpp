// SPDX-License-Identifier: Apache-2.0
// What lies pressed as a picture of numbers: a file that a simulation ends with and the next begins
// with.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "shared/track_seen.h"
#include "tracks/tracks.h"

namespace sward::tracks {

namespace {

constexpr int kSide = shared::kTrackCells;

struct Corner {
    double cell_m = 0;
    int x = 0, z = 0;
};

/// What the picture says of its own place; nothing where it says nothing.
std::optional<Corner> corner_of(const scene::Image& picture) {
    const auto found = picture.metadata.find(kPictureKey);
    if (found == picture.metadata.end()) {
        return std::nullopt;
    }
    Corner corner;
    const std::string& text = found->second;
    const char* at = text.data();
    const char* const end = at + text.size();
    auto result = std::from_chars(at, end, corner.cell_m);
    for (int* number : {&corner.x, &corner.z}) {
        if (result.ec != std::errc() || result.ptr == end) {
            return std::nullopt;
        }
        result = std::from_chars(result.ptr + 1, end, *number);
    }
    constexpr int kFarthest = 10'000'000;
    const bool fits = result.ec == std::errc() && std::abs(corner.x) < kFarthest &&
                      std::abs(corner.z) < kFarthest;
    return fits ? std::optional(corner) : std::nullopt;
}

} // namespace

std::vector<glm::vec2> Tracks::lying(PageKey key) const {
    const int slot = pages_.slot_of(key);
    std::vector<std::uint32_t> words;
    float left = rules_.left;
    if (slot >= 0) {
        words = pass_.get(slot);
    } else if (std::optional<PageContent> content = memory_.look(key)) {
        words = std::move(content->pressed);
        const auto span = static_cast<float>(spec_.lasting_s) / shared::kTrackEpochs;
        left *= shared::track_left(span * static_cast<float>(epoch_ - content->epoch),
                                   static_cast<float>(spec_.lasting_s));
    }
    std::vector<glm::vec2> cells;
    cells.reserve(words.size());
    for (const std::uint32_t word : words) {
        cells.push_back(shared::track_unpack(word) * left);
    }
    return cells;
}

scene::Image Tracks::picture() const {
    std::vector<PageKey> keys = memory_.keys();
    for (const int slot : pages_.in_order()) {
        keys.push_back(pages_.slots()[static_cast<std::size_t>(slot)].key);
    }
    scene::Image out;
    out.channels = {"pressed.X", "pressed.Y"};
    if (keys.empty()) {
        return out;
    }
    PageKey low = keys.front(), high = keys.front();
    for (const PageKey key : keys) {
        low = glm::min(low, key);
        high = glm::max(high, key);
    }
    const glm::dvec2 size = (glm::dvec2(high) - glm::dvec2(low) + 1.0) * static_cast<double>(kSide);
    if (size.x > kMostSide || size.y > kMostSide) {
        throw base::Error(
            base::ExitCode::kOverLimit,
            fmt::format(
                "tracks: found a picture of {:.0f} x {:.0f} cells, expected at most {} a side",
                size.x, size.y, kMostSide));
    }
    out.width = static_cast<int>(size.x);
    out.height = static_cast<int>(size.y);
    out.texels.assign(
        2 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 0.0f);
    out.metadata[kPictureKey] = fmt::format("{} {} {}", spec_.cell_m, low.x, low.y);
    for (const PageKey key : keys) {
        const std::vector<glm::vec2> cells = lying(key);
        const glm::ivec2 first = (key - low) * kSide;
        for (std::size_t n = 0; n < cells.size(); ++n) {
            const glm::ivec2 at =
                first + glm::ivec2(static_cast<int>(n) % kSide, static_cast<int>(n) / kSide);
            const std::size_t texel =
                2 * (static_cast<std::size_t>(at.y) * static_cast<std::size_t>(out.width) +
                     static_cast<std::size_t>(at.x));
            out.texels[texel] = cells[n].x;
            out.texels[texel + 1] = cells[n].y;
        }
    }
    return out;
}

void Tracks::begin_with(const scene::Image& picture, const std::string& name) {
    const auto refuse = [&](const std::string& found, const std::string& expected) {
        return base::Error(base::ExitCode::kBadInput,
                           fmt::format("{}: found {}, expected {}", name, found, expected));
    };
    const std::optional<Corner> corner = corner_of(picture);
    const auto x = std::find(picture.channels.begin(), picture.channels.end(), "pressed.X"),
               z = std::find(picture.channels.begin(), picture.channels.end(), "pressed.Y");
    if (!corner || x == picture.channels.end() || z == picture.channels.end()) {
        throw refuse("no tracks", fmt::format("a picture that --save-tracks wrote: channels "
                                              "pressed.X, pressed.Y and the attribute {}",
                                              kPictureKey));
    }
    if (std::abs(corner->cell_m - spec_.cell_m) > 1e-9) {
        throw refuse(fmt::format("cells of {} m", corner->cell_m),
                     fmt::format("the scene's, {} m (tracks.cell_m)", spec_.cell_m));
    }
    if (picture.width < 1 || picture.height < 1 || picture.width % kSide != 0 ||
        picture.height % kSide != 0) {
        throw refuse(fmt::format("{} x {} cells", picture.width, picture.height),
                     fmt::format("whole pages of {} cells a side", kSide));
    }
    const std::size_t channels = picture.channels.size();
    const auto cx = static_cast<std::size_t>(x - picture.channels.begin()),
               cz = static_cast<std::size_t>(z - picture.channels.begin());
    for (const float value : picture.texels) {
        if (!(std::abs(value) <= 1.001f)) {
            throw refuse(fmt::format("a value of {}", value), "numbers from -1 to 1");
        }
    }
    forget();
    for (int row = 0; row < picture.height / kSide; ++row) {
        for (int column = 0; column < picture.width / kSide; ++column) {
            PageContent content;
            content.pressed.resize(std::size_t{kSide} * kSide);
            bool something = false;
            for (std::size_t n = 0; n < content.pressed.size(); ++n) {
                const std::size_t at =
                    channels * ((static_cast<std::size_t>(row * kSide) + n / kSide) *
                                    static_cast<std::size_t>(picture.width) +
                                static_cast<std::size_t>(column * kSide) + n % kSide);
                content.pressed[n] =
                    shared::track_pack({picture.texels[at + cx], picture.texels[at + cz]});
                something = something || content.pressed[n] != 0;
            }
            if (something) {
                memory_.put({corner->x + column, corner->z + row}, content);
            }
        }
    }
    first_ = picture;
    first_name_ = name;
}

} // namespace sward::tracks
