// SPDX-License-Identifier: Apache-2.0
#include "texgen/seam/stack_json.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::uint64_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxLayers = 2048;
constexpr double kMaxMetres = 1000;
constexpr std::string_view kOtherVariant =
    "variant"; // "variant1_layer03": only the first variant is a stack of ours

class Reading {
public:
    explicit Reading(fs::path file) : file_(std::move(file)), folder_(file_.parent_path()) {}

    StackDescription run() {
        const std::string text = base::read_text(file_, kMaxBytes);
        if (std::ranges::count_if(text, [](char c) { return c == '[' || c == '{'; }) >
            static_cast<std::ptrdiff_t>(8 * kMaxLayers))
            refuse("JSON", "too many brackets", "a list of pictures");
        const json root = json::parse(text, nullptr, false);
        if (!root.is_object() || !root.contains("images") || !root["images"].is_array() ||
            root["images"].size() > 2 * kMaxLayers)
            refuse("JSON", "something else",
                   fmt::format("an object with a list \"images\" of at most {}", 2 * kMaxLayers));
        StackDescription out;
        if (root.contains("preset") && root["preset"].is_string())
            out.name = root["preset"].get<std::string>();
        out.side_m = metres(root, "side_m");
        out.canopy_m = metres(root, "canopy_m");
        for (const json& image : root["images"])
            layer(image, out.layers);
        if (out.layers.empty())
            refuse("images", "no layer", "pictures seen from above");
        const auto known = [](const StackLayer& l) { return l.height_m.has_value(); };
        if (std::ranges::any_of(out.layers, known) && !std::ranges::all_of(out.layers, known))
            refuse("images: height_m", "some without", "a height for all of them, or for none");
        if (!std::ranges::is_sorted(out.layers, {},
                                    [](const StackLayer& l) { return l.height_m.value_or(0); }))
            refuse("images: height_m", "a layer below the one before it", "rising heights");
        return out;
    }

private:
    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(base::ExitCode::kBadInput, file_, 0, what, base::printable(found),
                                expected);
    }

    std::optional<double> metres(const json& from, const char* key) const {
        if (!from.contains(key) || from[key].is_null())
            return std::nullopt;
        const json& value = from[key];
        if (!value.is_number() || !(value.get<double>() >= 0 && value.get<double>() <= kMaxMetres))
            refuse(key, value.dump(-1, ' ', true, json::error_handler_t::replace),
                   fmt::format("metres from 0 to {}", kMaxMetres));
        return value.get<double>();
    }

    /// The file itself, or one that --export makes for the name.
    std::string file_of(const json& image) const {
        const auto text = [&](const char* key) {
            return image.contains(key) && image[key].is_string() ? image[key].get<std::string>()
                                                                 : std::string();
        };
        std::string file = text("file");
        std::error_code ignored;
        for (const char* ending : {"_albedo.png", ".exr", ".png", ""})
            if (file.empty() && !text("name").empty() &&
                fs::is_regular_file(folder_ / (text("name") + ending), ignored))
                file = text("name") + ending;
        if (file.empty() || file.find('/') != std::string::npos ||
            file.find('\0') != std::string::npos || file.size() > 255)
            refuse("images: file", file.empty() ? text("name") : file,
                   "the name of a picture beside it");
        return file;
    }

    void layer(const json& image, std::vector<StackLayer>& out) const {
        if (!image.is_object())
            refuse("images", "something else", "objects with \"file\" and \"height_m\"");
        const std::string name = image.contains("name") && image["name"].is_string()
                                     ? image["name"].get<std::string>()
                                     : "";
        if (image.contains("middle_m") ||
            (name.starts_with(kOtherVariant) && !name.starts_with("variant0_")))
            return;
        out.push_back({file_of(image), metres(image, "height_m")});
    }

    fs::path file_, folder_;
};

} // namespace

std::optional<StackDescription> read_stack_json(const fs::path& directory) {
    std::error_code error;
    const fs::path file = directory / kStackJson;
    if (!fs::exists(fs::symlink_status(file, error)))
        return std::nullopt;
    return Reading(file).run();
}

std::string stack_json_text(const StackDescription& stack) {
    ordered_json root = {{"format", "Sward layer stack"}};
    if (!stack.name.empty())
        root["preset"] = stack.name;
    if (stack.side_m)
        root["side_m"] = *stack.side_m;
    if (stack.canopy_m)
        root["canopy_m"] = *stack.canopy_m;
    root["images"] = ordered_json::array();
    for (const StackLayer& layer : stack.layers) {
        ordered_json image = {{"file", layer.file}};
        if (layer.height_m)
            image["height_m"] = *layer.height_m;
        root["images"].push_back(image);
    }
    return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

} // namespace sward::texgen
